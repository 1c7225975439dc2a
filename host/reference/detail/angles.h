// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Computes texture coordinates by angles from a direction that a rotation carries along, and
// lengths along the profile that the support function gives (frustum.cpp).
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "reference/shapes.h"

namespace caplet::reference {

inline constexpr double pi = full_turn / 2;

inline double share(double x, double whole) {
  return whole != 0 ? std::clamp(x / whole, 0.0, 1.0) : 0.0;
}

/// Returns v turned by the shortest rotation that takes the unit vector `from` to the unit vector
/// `to`, not opposite to it (Rodrigues's formula).
inline glm::dvec3 turned(const glm::dvec3& v, const glm::dvec3& from, const glm::dvec3& to) {
  const glm::dvec3 moment = glm::cross(from, to);
  const double sine = glm::length(moment);
  if (!(sine > 0)) return v;
  const glm::dvec3 axis = moment / sine;
  const double angle = std::atan2(sine, glm::dot(from, to));
  return std::cos(angle) * v + std::sin(angle) * glm::cross(axis, v) +
         (1 - std::cos(angle)) * glm::dot(axis, v) * axis;
}

/// Returns where angles around a unit vector begin.
inline glm::dvec3 beginning(const glm::dvec3& axis) {
  return turned({1, 0, 0}, {0, 0, axis.z >= -0.9 ? 1.0 : -1.0}, axis);
}

/// Returns the angle in [0, 2 pi) around `axis` (unit), of w from somewhere on it.
inline double angle_around(const glm::dvec3& axis, const glm::dvec3& w) {
  const glm::dvec3 east = beginning(axis);
  const double angle = std::atan2(glm::dot(w, glm::cross(axis, east)), glm::dot(w, east));
  return angle < 0 ? angle + full_turn : angle;
}

/// Returns angle_around z; beyond phi_max the nearer end of [0, phi_max].
inline double angle_within(const glm::dvec3& x, double phi_max) {
  const double angle = angle_around({0, 0, 1}, x);
  if (angle <= phi_max) return angle;
  return angle - phi_max < full_turn - angle ? phi_max : 0;
}

/// OnFrustum is a point relative to the hull of two ends: p, along and across the axis, and u, its
/// turn around it.
struct OnFrustum {
  glm::dvec2 p;
  double u;
};
inline OnFrustum on_frustum(const Frustum& s, const glm::dvec3& x) {
  const glm::dvec3 w = x - s.p0;
  const double along = glm::dot(w, s.axis);
  return {{along, glm::length(w - along * s.axis)}, share(angle_around(s.axis, w), full_turn)};
}

/// Returns the angle of the half plane's vector w from the pole against the axis, in [0, pi].
inline double angle_from_pole(const glm::dvec2& w) { return std::atan2(w.y, -w.x); }

/// Position says where on the segment from a to b the point nearest to p lies (0 to 1), and how far
/// p is from it.
struct Position {
  double share, away;
};
inline Position between(const glm::dvec2& p, const glm::dvec2& a, const glm::dvec2& b) {
  const glm::dvec2 ab = b - a;
  const double squared = glm::dot(ab, ab);
  const double s = squared > 0 ? std::clamp(glm::dot(p - a, ab) / squared, 0.0, 1.0) : 0.0;
  return {s, glm::length(p - (a + s * ab))};
}

}  // namespace caplet::reference
