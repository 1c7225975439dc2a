// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Points on the surface of a light by the test's own parametrisation.
#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <vector>

#include "scene/scene.h"

namespace caplet::test {

/// A point of a light's surface with its share of the area (world).
struct SurfacePoint {
  glm::dvec3 p, n;  // n unit; outward of solids, emitting side of open shapes
  double area;
};

/// `count` points a smooth part of the shape's emitting surface, evenly spread in its own
/// coordinates; areas from the derivatives of the transformed parametrisation, taken by
/// differences. Throws std::logic_error for a shape that it has no coordinates of; csg shapes:
/// unions and intersections of balls that hold the origin.
std::vector<SurfacePoint> surface_points(const Shape& shape, std::size_t count);

}  // namespace caplet::test
