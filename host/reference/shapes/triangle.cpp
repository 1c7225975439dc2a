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

bool has_inside(const Triangle&) { return false; }

double value_of(const Triangle& t, const dvec3& x) {
  const dvec3 n = glm::cross(t.v1 - t.v0, t.v2 - t.v0);
  const dvec3* v[3] = {&t.v0, &t.v1, &t.v2};
  double to_edges = HUGE_VAL;
  bool above = true;
  for (int i = 0; i < 3; ++i) {
    const dvec3 &a = *v[i], &b = *v[(i + 1) % 3];
    to_edges = std::min(to_edges, distance_to_segment(x, a, b));
    above = above && glm::dot(glm::cross(n, b - a), x - a) >= 0;
  }
  const double length = glm::length(n);
  return above && length > 0 ? std::abs(glm::dot(n, x - t.v0)) / length : to_edges;
}

Ball ball_of(const Triangle& t) {
  const dvec3 center = (t.v0 + t.v1 + t.v2) / 3.0;
  return {center, std::max({glm::length(t.v0 - center), glm::length(t.v1 - center),
                            glm::length(t.v2 - center)})};
}

dvec3 sheet_normal(const Triangle& t, const dvec3&) {
  return glm::normalize(glm::cross(t.v1 - t.v0, t.v2 - t.v0));
}

std::vector<Curve> boundary_of(const Triangle& t) {
  return {segment(t.v0, t.v1), segment(t.v1, t.v2), segment(t.v2, t.v0)};
}

dvec2 uv_of(const Triangle& t, const dvec3& x, int) {
  const dvec3 n = glm::cross(t.v1 - t.v0, t.v2 - t.v0);
  const double twice_area = glm::dot(n, n);
  if (!(twice_area > 0)) return {0, 0};
  const auto part = [&](const dvec3& a, const dvec3& b) {  // the triangle a b x, of the whole
    return std::max(0.0, glm::dot(glm::cross(b - a, x - a), n) / twice_area);
  };
  const double b0 = part(t.v1, t.v2), b1 = part(t.v2, t.v0), b2 = part(t.v0, t.v1),
               sum = b0 + b1 + b2;
  return {(b1 + b2) / sum, b2 / sum};  // (0 0) (1 0) (1 1)
}

std::vector<Primitive> references_of(const TriangleMeshShape& mesh) {
  std::vector<Primitive> out;
  for (const auto& t : mesh.triangles)
    out.push_back(Triangle{dvec3(mesh.positions[t[0]]), dvec3(mesh.positions[t[1]]),
                           dvec3(mesh.positions[t[2]])});
  return out;
}

}  // namespace caplet::reference
