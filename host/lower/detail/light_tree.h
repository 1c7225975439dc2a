// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The tree that many lights are chosen by (kernels/lights/tree.cl).
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>

#include "lower/flat_scene.h"

namespace caplet {

/// What the light tree knows of a light, or of several together.
struct LightBounds {
  glm::dvec3 min{0}, max{0};  // box in the world
  glm::dvec3 axis{0, 0, 1};   // of a cone that holds the directions of its normals, and that cone's cosine; -1: all
  double cos_cone = -1;
  double cos_reach = 0;  // of the greatest angle between a normal and light that goes off
  double intensity = 0;  // luminous, seen along a normal from afar; > 0
};

/// Both together. Conty Estevez and Kulla 2018, section 4.1.
LightBounds united(const LightBounds& a, const LightBounds& b);

struct TreeLight {
  std::uint32_t light;
  LightBounds bounds;
};

/// Writes light_nodes, light_places (of all `light_count` lights) and the grid and number of nodes in `lighting`. `lights` in any
/// order, each once; none: no tree. The same for any number of threads.
void lower_light_tree(std::span<const TreeLight> lights, std::size_t light_count, FlatScene& out);

}  // namespace caplet
