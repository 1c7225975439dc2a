// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include <cmath>
#include <glm/geometric.hpp>

#include "reference/detail/angles.h"
#include "reference/detail/parts.h"

namespace caplet::reference {

using glm::dvec2;
using glm::dvec3;

bool has_inside(const Sphere&) { return true; }
double value_of(const Sphere& s, const dvec3& x) { return glm::length(x - s.center) - s.radius; }
Ball ball_of(const Sphere& s) { return {s.center, s.radius}; }

dvec2 uv_of(const Sphere& s, const dvec3& x, int) {
  const dvec3 w = x - s.center;
  return {share(angle_around({0, 0, 1}, w), full_turn),
          share(std::atan2(w.z, std::hypot(w.x, w.y)) + pi / 2, pi)};
}

std::vector<Primitive> references_of(const SphereShape& s) { return {Sphere{dvec3(0), s.radius}}; }

}  // namespace caplet::reference
