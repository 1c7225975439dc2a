// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Parts of the unit sphere that planes cut out.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "scene/bounds.h"

namespace caplet {

/// The points d of the unit sphere with dot(normal, d) <= offset. The cap is the rest.
struct SpherePlane {
  glm::dvec3 normal;  // unit
  double offset;
};

/// What lies within all of some planes.
struct SphereRegion {
  std::vector<std::uint32_t> planes;  // those that are needed
  Bounds bounds;                      // empty when the region is
};

/// Returns the numbers of the planes whose circles meet what lies within all planes.
std::vector<std::uint32_t> bounding_planes(std::span<const SpherePlane> planes);

/// Computes the region of `planes`. `bounding` has at least the planes whose circles meet it; the
/// others' circles lie outside, but their caps may hide what the bounding ones leave.
SphereRegion sphere_region(std::span<const SpherePlane> planes,
                           std::vector<std::uint32_t> bounding);

/// Returns a unit vector that is orthogonal to a unit vector.
glm::dvec3 any_orthogonal(const glm::dvec3& unit);

}  // namespace caplet
