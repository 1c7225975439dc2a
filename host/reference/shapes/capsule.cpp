// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "reference/detail/angles.h"
#include "reference/detail/parts.h"

namespace caplet::reference {

using glm::dvec2;
using glm::dvec3;

bool has_inside(const Capsule&) { return true; }
std::size_t which_kind(const Capsule& capsule) {
  return capsule.radius0 == capsule.radius1 ? 0 : 1;
}

// Returns the least of |x - c(s)| - r(s) over the balls of the hull. With y along the axis and rho
// across it, that is convex in s and has no slope where (s L - y) / |x - c(s)| = k, the growth of
// the radius by length: s L = y + rho k / sqrt(1 - k^2).
double value_of(const Capsule& c, const dvec3& x) {
  const dvec3 axis = c.p1 - c.p0, w = x - c.p0;
  const double growth = c.radius1 - c.radius0, squared = glm::dot(axis, axis);
  const auto at = [&](double s) { return glm::length(w - s * axis) - (c.radius0 + s * growth); };
  // Here one ball holds the other.
  if (growth * growth >= squared) return at(growth > 0 ? 1 : 0);
  const double along = glm::dot(w, axis) / squared;
  const double across = glm::length(w - along * axis);
  return at(std::clamp(along + across * growth / std::sqrt(squared * (squared - growth * growth)),
                       0.0, 1.0));
}

Ball ball_of(const Capsule& c) {
  return {0.5 * (c.p0 + c.p1), 0.5 * glm::length(c.p1 - c.p0) + std::max(c.radius0, c.radius1)};
}

// The hull of two balls has a cap, a side and a cap, by arc length.
dvec2 uv_of(const Capsule& c, const dvec3& x, int) {
  const Frustum s = make_frustum(c.p0, c.p1, {c.radius0, true, false}, {c.radius1, true, false});
  const OnFrustum at = on_frustum(s, x);
  if (s.side_count == 0) {
    const dvec2 w = at.p - dvec2(c.radius0 >= c.radius1 ? 0 : s.length, 0);
    return {at.u, share(angle_from_pole(w), pi)};
  }
  const dvec2 n = s.side_normals[0], begin = side_contact(s, 0, n), end = side_contact(s, 1, n);
  const double rim = angle_from_pole(n), side = glm::length(end - begin);
  const double first = c.radius0 * rim, last = c.radius1 * (pi - rim);
  double arc = 0;
  switch (surface_of(s, x).surface) {
    case 0:
      arc = first + side * between(at.p, begin, end).share;
      break;
    case 1:
      arc = c.radius0 * std::min(rim, angle_from_pole(at.p));
      break;
    default:
      arc = first + side +
            c.radius1 * std::max(0.0, angle_from_pole(at.p - dvec2(s.length, 0)) - rim);
  }
  return {at.u, share(arc, first + side + last)};
}

// Returns the uv of pbrt's curves: u as at the ball that touches the surface there, v by how far to
// the side of the axis the ray passes, over how far it may at that ball.
dvec2 chain_uv_of(const Capsule& c, const dvec3& x, const dvec3& direction) {
  dvec3 axis = c.p1 - c.p0;
  const double length = glm::length(axis), growth = c.radius1 - c.radius0;
  axis = length > 0 ? axis / length : dvec3(0, 0, 1);
  // Where one ball holds the other, u is that of the larger one; where both have one centre, it is
  // that of p0.
  double s = growth > 0 && length > 0 ? 1 : 0, radius = std::max(c.radius0, c.radius1), cosine = 1;
  if (length > std::abs(growth)) {
    cosine = std::sqrt((length - growth) * (length + growth)) / length;
    const double along = glm::dot(x - c.p0, axis), across = glm::length(x - c.p0 - along * axis);
    s = std::clamp((along + across * growth / (length * cosine)) / length, 0.0, 1.0);
    radius = c.radius0 + s * growth;
  }
  const dvec3 sideways = glm::cross(direction, axis);
  const double offset = glm::dot(x - c.p0, sideways) / std::max(glm::length(sideways), 1e-300);
  return {glm::mix(c.u->x, c.u->y, s),
          std::clamp(0.5 + 0.5 * offset / std::max(radius * cosine, 1e-300), 0.0, 1.0)};
}

std::vector<Primitive> references_of(const CapsulesShape& capsules) {
  std::vector<Primitive> out;
  for (std::size_t i = 0; i < count_of(capsules); ++i) {
    const double radius0 = capsules.radius0[i];
    const double radius1 =
        capsules.radius1.empty() ? radius0 : static_cast<double>(capsules.radius1[i]);
    std::optional<dvec2> u;
    if (!capsules.u.empty()) u = dvec2(capsules.u[i]);
    out.push_back(Capsule{dvec3(capsules.p0[i]), dvec3(capsules.p1[i]), radius0, radius1, u});
  }
  return out;
}

}  // namespace caplet::reference
