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

bool has_inside(const Polyhedron&) { return true; }
int surfaces_of(const Polyhedron& p) { return static_cast<int>(p.normals.size()); }
Ball ball_of(const Polyhedron& p) { return {p.ball_center, p.ball_radius}; }

namespace {

Greatest greatest_of(const Polyhedron& p, const dvec3& x) {
  Greatest out;
  const dvec3 w = x - p.center;
  for (std::size_t i = 0; i < p.normals.size(); ++i)
    out.add(glm::dot(p.normals[i], w) - p.offsets[i], static_cast<int>(i));
  return out;
}

}  // namespace

double value_of(const Polyhedron& p, const dvec3& x) { return greatest_of(p, x).value; }
SurfaceAt surface_of(const Polyhedron& p, const dvec3& x) { return greatest_of(p, x).at(); }
double distance_from(const Polyhedron& p, const dvec3& x, int surface) {
  const auto i = static_cast<std::size_t>(surface);
  return std::abs(glm::dot(p.normals[i], x - p.center) - p.offsets[i]);
}
dvec3 normal_of(const Polyhedron& p, const dvec3&, int surface) {
  return p.normals[static_cast<std::size_t>(surface)];
}

dvec2 uv_of(const Polyhedron& p, const dvec3& x, int surface) {
  dvec3 low(HUGE_VAL), high(-HUGE_VAL);
  for (const dvec3& corner : p.corners) {
    low = glm::min(low, corner);
    high = glm::max(high, corner);
  }
  const dvec3 center = 0.5 * (low + high), n = p.normals[static_cast<std::size_t>(surface)],
              east = beginning(n);
  double radius = 0;
  for (const dvec3& corner : p.corners) radius = std::max(radius, glm::length(corner - center));
  const dvec3 w = x - center;
  return {share(glm::dot(w, east) + radius, 2 * radius),
          share(glm::dot(w, glm::cross(n, east)) + radius, 2 * radius)};
}

Polyhedron make_polyhedron(const dvec3& center, std::span<const dvec3> normals,
                           std::span<const double> offsets) {
  Polyhedron out;
  out.center = center;
  for (std::size_t i = 0; i < normals.size(); ++i) {
    const double size = glm::length(normals[i]);
    out.normals.push_back(normals[i] / size);
    out.offsets.push_back(offsets[i] / size);
  }
  // Corners are the ends of edges; an edge is the part of the line of two planes that the other
  // planes leave.
  const std::size_t n = out.normals.size();
  dvec3 low(HUGE_VAL), high(-HUGE_VAL);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i + 1; j < n; ++j) {
      const dvec3 a = out.normals[i], b = out.normals[j], along = glm::cross(a, b);
      const double sine2 = glm::dot(along, along);
      if (sine2 < 1e-24) continue;
      const dvec3 on =
          (out.offsets[i] * glm::cross(b, along) + out.offsets[j] * glm::cross(along, a)) / sine2;
      double from = -HUGE_VAL, to = HUGE_VAL;
      for (std::size_t k = 0; k < n; ++k) {
        if (k == i || k == j) continue;
        const double slope = glm::dot(out.normals[k], along),
                     height = glm::dot(out.normals[k], on) - out.offsets[k];
        if (std::abs(slope) < 1e-14) {
          if (height > 1e-9 * glm::length(on)) to = -HUGE_VAL;
        } else if (slope > 0) {
          to = std::min(to, -height / slope);
        } else {
          from = std::max(from, -height / slope);
        }
      }
      const double slack = 1e-9 * (std::abs(from) + std::abs(to));
      if (!(from <= to + slack) || !std::isfinite(from) || !std::isfinite(to)) continue;
      for (const double s : {from, to}) out.corners.push_back(center + on + s * along);
    }
  for (const dvec3& corner : out.corners) {
    low = glm::min(low, corner);
    high = glm::max(high, corner);
  }
  out.ball_center = 0.5 * (low + high);
  for (const dvec3& corner : out.corners)
    out.ball_radius = std::max(out.ball_radius, glm::length(corner - out.ball_center));
  out.ball_radius *= 1 + 1e-6;
  return out;
}

std::vector<Primitive> references_of(const PolyhedronShape& p) {
  dvec3 center{0};
  for (const dvec3& point : p.points) center += point / double(p.points.size());
  std::vector<double> offsets;
  for (std::size_t i = 0; i < p.points.size(); ++i)
    offsets.push_back(glm::dot(p.normals[i], p.points[i] - center));
  return {make_polyhedron(center, p.normals, offsets)};
}

}  // namespace caplet::reference
