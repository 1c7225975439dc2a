// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "reference/detail/angles.h"
#include "reference/detail/parts.h"

namespace caplet::reference {

using glm::dvec2;
using glm::dvec3;

bool has_inside(const Disk&) { return false; }

double value_of(const Disk& d, const dvec3& x) {
  const dvec3 n = glm::normalize(d.normal);
  const double height = glm::dot(n, x - d.center);
  const double outside = std::max(0.0, glm::length(x - d.center - height * n) - d.radius);
  return std::hypot(height, outside);
}

Ball ball_of(const Disk& d) { return {d.center, d.radius}; }

dvec3 sheet_normal(const Disk& d, const dvec3&) { return glm::normalize(d.normal); }

std::vector<Curve> boundary_of(const Disk& d) {
  const dvec3 n = glm::normalize(d.normal), u = any_perpendicular(n);
  return {{Curve::Kind::arc, d.center, u, glm::cross(n, u), d.radius, 0, full_turn}};
}

dvec2 uv_of(const Disk& d, const dvec3& x, int) {
  const dvec3 n = glm::normalize(d.normal), w = x - d.center;
  return {share(angle_around(n, w), full_turn),
          1 - share(glm::length(w - glm::dot(w, n) * n), d.radius)};
}

std::vector<Primitive> references_of(const DiskShape& d) {
  if (d.is_whole()) return {Disk{dvec3(0, 0, d.height), dvec3(0, 0, 1), d.radius}};
  return {PartialDisk{d.height, d.radius, d.inner_radius, d.phi_max}};
}

}  // namespace caplet::reference
