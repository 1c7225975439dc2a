// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Makes the tree that many lights are chosen by (kernels/lights/tree.cl).
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "lower/flat_scene.h"

namespace caplet {

/// LightBounds is what the light tree stores of a light, or of several together.
struct LightBounds {
  glm::dvec3 min{0}, max{0};  // box in the world
  glm::dvec3 axis{
      0, 0,
      1};  // of a cone that holds the directions of its normals, and that cone's cosine; -1: all
  double cos_cone = -1;
  double cos_reach = 0;  // of the greatest angle between a normal and light that goes off
  double intensity = 0;  // luminous, seen along a normal from afar; > 0
};

/// Returns the bounds of both together (Conty Estevez and Kulla 2018, section 4.1).
LightBounds united(const LightBounds& a, const LightBounds& b);

/// TreeLights are lights as the tree takes them: a cache line each, and more for those that do not
/// shine everywhere.
struct TreeLights {
  static constexpr std::uint32_t all_around = 0xffffffff;
  struct alignas(64) One {
    double min[3], max[3], intensity;  // as in LightBounds
    std::uint32_t light;
    std::uint32_t
        cone;  // of `cones`; all_around: normals everywhere, and light up to a right angle off them
  };
  static_assert(sizeof(One) == 64);
  struct Cone {
    glm::dvec3 axis;
    double cos_cone, cos_reach;
  };
  std::vector<One> lights;
  std::vector<Cone> cones;

  void add(std::uint32_t light, const LightBounds& bounds);
  LightBounds bounds_of(const One& light) const;
};

/// Writes light_nodes, light_places (of all `light_count` lights) and the grid in `lighting`.
/// `lights` are in any order, each once; none: no tree. The result is the same for any number of
/// threads.
void lower_light_tree(const TreeLights& lights, std::size_t light_count, FlatScene& out);

}  // namespace caplet
