// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Distances to the shapes. The hull of two spheres is a minimum over its balls, found by bisection of the slope.
#include "reference/primitive.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace caplet::reference {

namespace {

using glm::dvec3;

// Bisections of the ball parameter. The value has zero slope at its minimum, so an error of 2^-44 of the length there is one of
// about 2^-88 of length^2 / radius in the value.
constexpr int ball_bisections = 44;

double distance_to_segment(const dvec3& x, const dvec3& a, const dvec3& b) {
  const dvec3 ab = b - a;
  const double squared = glm::dot(ab, ab);
  const double s = squared > 0 ? std::clamp(glm::dot(x - a, ab) / squared, 0.0, 1.0) : 0.0;
  return glm::length(x - (a + s * ab));
}

double value_of(const Sphere& s, const dvec3& x) { return glm::length(x - s.center) - s.radius; }

double value_of(const Capsule& c, const dvec3& x) {
  const dvec3 axis = c.p1 - c.p0;
  const double growth = c.radius1 - c.radius0;
  if (growth == 0) return distance_to_segment(x, c.p0, c.p1) - c.radius0;
  const auto at = [&](double s) { return glm::length(x - (c.p0 + s * axis)) - (c.radius0 + s * growth); };
  // Slope of `at`, times the distance; it rises with s, since `at` is convex.
  const auto rises = [&](double s) {
    const dvec3 to_center = c.p0 + s * axis - x;
    return glm::dot(to_center, axis) > growth * glm::length(to_center);
  };
  double low = 0, high = 1;
  if (rises(low)) return at(low);
  if (!rises(high)) return at(high);
  for (int i = 0; i < ball_bisections; ++i) {
    const double middle = 0.5 * (low + high);
    (rises(middle) ? high : low) = middle;
  }
  return std::min(at(low), at(high));
}

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

double value_of(const Disk& d, const dvec3& x) {
  const dvec3 n = glm::normalize(d.normal);
  const double height = glm::dot(n, x - d.center);
  const double outside = std::max(0.0, glm::length(x - d.center - height * n) - d.radius);
  return std::hypot(height, outside);
}

Ball ball_of(const Sphere& s) { return {s.center, s.radius}; }
Ball ball_of(const Capsule& c) { return {0.5 * (c.p0 + c.p1), 0.5 * glm::length(c.p1 - c.p0) + std::max(c.radius0, c.radius1)}; }
Ball ball_of(const Triangle& t) {
  const dvec3 center = (t.v0 + t.v1 + t.v2) / 3.0;
  return {center, std::max({glm::length(t.v0 - center), glm::length(t.v1 - center), glm::length(t.v2 - center)})};
}
Ball ball_of(const Disk& d) { return {d.center, d.radius}; }

}  // namespace

bool is_solid(const Primitive& primitive) {
  return std::holds_alternative<Sphere>(primitive) || std::holds_alternative<Capsule>(primitive);
}

double value(const Primitive& primitive, const dvec3& x) {
  return std::visit([&](const auto& shape) { return value_of(shape, x); }, primitive);
}

Ball bounding_ball(const Primitive& primitive) {
  return std::visit([](const auto& shape) { return ball_of(shape); }, primitive);
}

dvec3 normal_at(const Primitive& primitive, const dvec3& x, double step) {
  if (const auto* triangle = std::get_if<Triangle>(&primitive))
    return glm::normalize(glm::cross(triangle->v1 - triangle->v0, triangle->v2 - triangle->v0));
  if (const auto* disk = std::get_if<Disk>(&primitive)) return glm::normalize(disk->normal);
  dvec3 gradient{0};
  for (int i = 0; i < 3; ++i) {
    dvec3 e{0};
    e[i] = step;
    gradient[i] = value(primitive, x + e) - value(primitive, x - e);
  }
  return glm::normalize(gradient);
}

}  // namespace caplet::reference
