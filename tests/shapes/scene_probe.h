// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Shapes as the program has them: a scene is lowered, its rays are traced on the device.
#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "device/device.h"
#include "lower/lower.h"
#include "scene/scene.h"
#include "support/test_device.h"

namespace caplet::test {

/// A hit with its surface, as the kernel writes it.
struct SceneHit {
  float t, u, v, error;
  float p[3];
  std::uint32_t found;  // 1: there is a hit; all else has no meaning without
  float ng[3];
  std::uint32_t surface;
  float ns[3];
  std::uint32_t leaving;
  float dpdu[3];
  std::uint32_t any;
  float dpdv[3];
  std::uint32_t instance;
};
static_assert(sizeof(SceneHit) == 96);

Shape shape_of(decltype(Shape::geometry) geometry,
               const glm::dmat4& world_from_object = glm::dmat4(1));

/// Scenes of these shapes, of one material.
FlatScene lower_shapes(std::vector<Shape> shapes);

/// `width`: CAPLET_REAL_WIDTH, 8 or 1.
std::vector<SceneHit> trace(const FlatScene& scene, const std::vector<RayRecord>& rays,
                            int width = test_width());

/// A surface that a ray met on its way.
struct WalkStep {
  float p[3], error;
};
struct Walk {
  std::vector<WalkStep> steps;  // in order
};
/// Every ray goes straight on through whatever it meets, from each surface by offset_origin, at
/// most `most` times.
std::vector<Walk> walk(const FlatScene& scene, const std::vector<RayRecord>& rays,
                       std::uint32_t most);

inline glm::dvec3 vec(const float* p) { return {p[0], p[1], p[2]}; }

}  // namespace caplet::test
