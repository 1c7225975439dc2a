// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Says where points of surfaces that move are at another time.
#pragma once

#include <cstddef>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <optional>

#include "scene/scene.h"

namespace caplet {

/// SurfacePlace tells which surface a point is of.
struct SurfacePlace {
  std::optional<std::size_t> instance = {};  // none: a shape of the world
  std::size_t shape = 0;                     // of the world or of the instance's object
  std::size_t primitive = 0;                 // within the shape: a capsule, a triangle
};

/// Carrier moves points with their surfaces from one time to another (seconds). Nothing moves
/// before the shutter opens and after it closes. Points of a triangle keep their barycentric
/// coordinates. Those of a capsule keep their share of its axis and, turned with it by the smallest
/// angle and stretched as the radius there, their offset from it. Operands of csg shapes are
/// carried with their shape.
class Carrier {
 public:
  Carrier(const Scene& scene, double from, double to);
  /// Returns where a point of the world goes that is on this surface.
  glm::dvec3 carried(const SurfacePlace& place, const glm::dvec3& point) const;

 private:
  Scene before_, after_;
};

}  // namespace caplet
