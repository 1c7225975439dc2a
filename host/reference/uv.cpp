// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Angles from a direction carried along by a rotation, lengths along the profile that the support function gives (spool.cpp).
#include "reference/detail/uv.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "reference/detail/parts.h"

namespace caplet::reference {

namespace {

using glm::dvec2;
using glm::dvec3;

constexpr double pi = full_turn / 2;

double share(double x, double whole) { return whole != 0 ? std::clamp(x / whole, 0.0, 1.0) : 0.0; }

/// v turned by the rotation that takes the unit vector `from` to the unit vector `to`, not opposite to it, the short way
/// (Rodrigues's formula).
dvec3 turned(const dvec3& v, const dvec3& from, const dvec3& to) {
  const dvec3 moment = glm::cross(from, to);
  const double sine = glm::length(moment);
  if (!(sine > 0)) return v;
  const dvec3 axis = moment / sine;
  const double angle = std::atan2(sine, glm::dot(from, to));
  return std::cos(angle) * v + std::sin(angle) * glm::cross(axis, v) + (1 - std::cos(angle)) * glm::dot(axis, v) * axis;
}

/// Where angles around a unit vector begin.
dvec3 beginning(const dvec3& axis) { return turned({1, 0, 0}, {0, 0, axis.z >= -0.9 ? 1.0 : -1.0}, axis); }

/// Angle in [0, 2 pi) around `axis` (unit), of w from somewhere on it.
double angle_around(const dvec3& axis, const dvec3& w) {
  const dvec3 east = beginning(axis);
  const double angle = std::atan2(glm::dot(w, glm::cross(axis, east)), glm::dot(w, east));
  return angle < 0 ? angle + full_turn : angle;
}

/// angle_around z; beyond phi_max the nearer end of [0, phi_max].
double angle_within(const dvec3& x, double phi_max) {
  const double angle = angle_around({0, 0, 1}, x);
  if (angle <= phi_max) return angle;
  return angle - phi_max < full_turn - angle ? phi_max : 0;
}

dvec2 uv_of(const Sphere& s, const dvec3& x, int) {
  const dvec3 w = x - s.center;
  return {share(angle_around({0, 0, 1}, w), full_turn), share(std::atan2(w.z, std::hypot(w.x, w.y)) + pi / 2, pi)};
}

/// A point relative to the hull of two ends: p, along and across the axis, and u, its turn around it.
struct OnSpool {
  dvec2 p;
  double u;
};
OnSpool on_spool(const Spool& s, const dvec3& x) {
  const dvec3 w = x - s.p0;
  const double along = glm::dot(w, s.axis);
  return {{along, glm::length(w - along * s.axis)}, share(angle_around(s.axis, w), full_turn)};
}

/// Angle of the half plane's vector w from the pole against the axis, in [0, pi].
double angle_from_pole(const dvec2& w) { return std::atan2(w.y, -w.x); }

/// Where on the segment from a to b the point nearest to p lies (0 to 1), and how far p is from it.
struct Position {
  double share, away;
};
Position between(const dvec2& p, const dvec2& a, const dvec2& b) {
  const dvec2 ab = b - a;
  const double squared = glm::dot(ab, ab);
  const double s = squared > 0 ? std::clamp(glm::dot(p - a, ab) / squared, 0.0, 1.0) : 0.0;
  return {s, glm::length(p - (a + s * ab))};
}

dvec2 uv_of(const Spool& s, const dvec3& x, int surface) {
  const OnSpool at = on_spool(s, x);
  if (surface == 0) {
    Position best{0, HUGE_VAL};
    for (int i = 0; i < s.side_count; ++i) {
      const dvec2 n = s.side_normals[static_cast<std::size_t>(i)];
      const Position position = between(at.p, side_contact(s, 0, n), side_contact(s, 1, n));
      if (position.away < best.away) best = position;
    }
    return {at.u, best.share};
  }
  const auto end = static_cast<std::size_t>(surface - 1);
  const dvec2 w = at.p - dvec2(end == 0 ? 0 : s.length, 0);
  if (!s.ends[end].round) {
    const double part = share(w.y, s.ends[end].radius);
    return {at.u, end == 0 ? part : 1 - part};
  }
  // From the pole to the circle that the side touches, or from there to the pole; whole spheres from pole to pole.
  if (s.side_count != 1) return {at.u, share(angle_from_pole(w), pi)};
  const double rim = angle_from_pole(s.side_normals[0]);
  return {at.u, end == 0 ? share(angle_from_pole(w), rim) : share(angle_from_pole(w) - rim, pi - rim)};
}

// The hull of two balls: cap, side and cap, by arc length.
dvec2 uv_of(const Capsule& c, const dvec3& x, int) {
  const Spool s = make_spool(c.p0, c.p1, {c.radius0, true, false}, {c.radius1, true, false});
  const OnSpool at = on_spool(s, x);
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
      arc = first + side + c.radius1 * std::max(0.0, angle_from_pole(at.p - dvec2(s.length, 0)) - rim);
  }
  return {at.u, share(arc, first + side + last)};
}

dvec2 uv_of(const Triangle& t, const dvec3& x, int) {
  const dvec3 n = glm::cross(t.v1 - t.v0, t.v2 - t.v0);
  const double twice_area = glm::dot(n, n);
  if (!(twice_area > 0)) return {0, 0};
  const auto part = [&](const dvec3& a, const dvec3& b) {  // the triangle a b x, of the whole
    return std::max(0.0, glm::dot(glm::cross(b - a, x - a), n) / twice_area);
  };
  const double b0 = part(t.v1, t.v2), b1 = part(t.v2, t.v0), b2 = part(t.v0, t.v1), sum = b0 + b1 + b2;
  return {(b1 + b2) / sum, b2 / sum};  // (0 0) (1 0) (1 1)
}

dvec2 uv_of(const Disk& d, const dvec3& x, int) {
  const dvec3 n = glm::normalize(d.normal), w = x - d.center;
  return {share(angle_around(n, w), full_turn), 1 - share(glm::length(w - glm::dot(w, n) * n), d.radius)};
}

dvec2 uv_of(const Box& b, const dvec3& x, int surface) {
  const dvec3 w = x - b.min, size = b.max - b.min;
  const int across = surface / 2, up = across == 2 ? 1 : 2;
  dvec3 outward{0}, upward{0};
  outward[across] = surface % 2 == 1 ? 1 : -1;
  upward[up] = 1;
  const dvec3 right = glm::cross(upward, outward);
  const int along = 3 - across - up;
  const double part = share(w[along], size[along]);
  return {right[along] > 0 ? part : 1 - part, share(w[up], size[up])};
}

dvec2 uv_of(const Polyhedron& p, const dvec3& x, int surface) {
  dvec3 low(HUGE_VAL), high(-HUGE_VAL);
  for (const dvec3& corner : p.corners) {
    low = glm::min(low, corner);
    high = glm::max(high, corner);
  }
  const dvec3 center = 0.5 * (low + high), n = p.normals[static_cast<std::size_t>(surface)], east = beginning(n);
  double radius = 0;
  for (const dvec3& corner : p.corners) radius = std::max(radius, glm::length(corner - center));
  const dvec3 w = x - center;
  return {share(glm::dot(w, east) + radius, 2 * radius), share(glm::dot(w, glm::cross(n, east)) + radius, 2 * radius)};
}

dvec2 uv_of(const PartialSphere& s, const dvec3& x, int) {
  const auto latitude = [](double z, double across) { return std::atan2(z, across); };
  const auto at_height = [&](double z) { return std::asin(std::clamp(z / s.radius, -1.0, 1.0)); };
  const double low = at_height(s.z_min), high = at_height(s.z_max);
  return {share(angle_within(x, s.phi_max), s.phi_max), share(latitude(x.z, std::hypot(x.x, x.y)) - low, high - low)};
}
dvec2 uv_of(const OpenCylinder& c, const dvec3& x, int) {
  return {share(angle_within(x, c.phi_max), c.phi_max), share(x.z - c.z_min, c.z_max - c.z_min)};
}
dvec2 uv_of(const PartialDisk& d, const dvec3& x, int) {
  return {share(angle_within(x, d.phi_max), d.phi_max), share(d.radius - std::hypot(x.x, x.y), d.radius - d.inner_radius)};
}

dvec2 uv_of(const Bilinear& b, const dvec3& x, int) { return parameters_of(b, x); }

dvec2 uv_of(const Csg& csg, const dvec3& x, int surface) {
  for (const CsgOperand& operand : csg.body->operands) {
    const int own = surface - operand.surface_begin;
    if (own >= 0 && own < surface_count(operand.primitive))
      return uv_at(operand.primitive, dvec3(operand.operand_from_csg * glm::dvec4(x, 1)), own);
  }
  return {0, 0};
}

}  // namespace

dvec2 uv_at(const Primitive& primitive, const dvec3& x, int surface) {
  if (surface < 0 || surface >= surface_count(primitive)) return {0, 0};
  return std::visit([&](const auto& shape) { return uv_of(shape, x, surface); }, primitive);
}

}  // namespace caplet::reference
