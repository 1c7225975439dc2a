// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "scene/shapes/ends.h"

#include "scene/shapes/shutter_keys.h"

namespace caplet {

namespace {

using glm::dvec3;

/// One end of a hull: a ball or a disk across the axis.
struct End {
  double radius;
  bool round;
};

/// Bounds the distance from a hull to a point at height y along the axis and rho off it; the ends
/// are at heights 0 and l. The hull is the union over s of sums of a disk and a ball whose radii
/// are linear in s. The distance from these is convex in s, and at any s it is no less than the
/// distance from the hull.
Beyond beyond_hull(double y, double rho, double l, const End& a, const End& b) {
  const auto at = [&](double s) {
    const double disk = (a.round ? 0 : (1 - s) * a.radius) + (b.round ? 0 : s * b.radius);
    const double ball = (a.round ? (1 - s) * a.radius : 0) + (b.round ? s * b.radius : 0);
    const double across = std::max(rho - disk, 0.0), along = y - s * l;
    return std::sqrt(across * across + along * along) - ball;
  };
  double low = 0, high = 1;
  for (int i = 0; i < 16; ++i) {
    const double s = low + (high - low) / 3, t = high - (high - low) / 3;
    if (at(s) < at(t))
      high = t;
    else
      low = s;
  }
  // The slope of `at` is below l + a.radius + b.radius.
  const double most = at((low + high) / 2);
  return {most - (high - low) * (l + a.radius + b.radius), most};
}

Beyond beyond_ends(const dvec3& p, const dvec3& p0, const dvec3& p1, const End& a, const End& b) {
  const double l = glm::length(p1 - p0);
  if (!(l > 0)) return Beyond::exactly(glm::length(p - p0) - std::max(a.radius, b.radius));
  const dvec3 axis = (p1 - p0) / l;
  const double y = glm::dot(p - p0, axis);
  const double rho = glm::length(p - p0 - y * axis);
  if (!a.round && !b.round) {
    // The solid is bounded by two planes and the side; its slope c keeps the function from growing
    // faster than distance.
    const double taper = (a.radius - b.radius) / l, c = 1 / std::sqrt(1 + taper * taper);
    return Beyond::exactly(std::max({-y, y - l, c * (rho - a.radius + taper * y)}));
  }
  if (!a.round || !b.round) return beyond_hull(y, rho, l, a, b);
  // The hull's distance is the least one of its balls, at shares s of the axis. Their distance is
  // convex in s, and its derivative is 0 where the ball is seen at the hull's slope.
  const double slope = (a.radius - b.radius) / l;
  const double s = std::abs(slope) < 1
                       ? std::clamp((y - rho * slope / std::sqrt(1 - slope * slope)) / l, 0.0, 1.0)
                   : slope > 0 ? 0.0
                               : 1.0;
  return Beyond::exactly(std::hypot(rho, y - s * l) - ((1 - s) * a.radius + s * b.radius));
}

/// Returns the bounds of balls or of disks with normal n across the axis, whose image has half
/// extents radius |row - (row.n) n|.
Bounds bounds_of_ends(const dvec3& p0, const dvec3& p1, double radius0, double radius1,
                      const std::array<Cap, 2>& caps, const glm::dmat4& m) {
  const glm::dmat3 a(m);
  const dvec3 n = glm::normalize(p1 - p0), ball = row_lengths(a);
  dvec3 disk;
  for (int k = 0; k < 3; ++k) {
    const dvec3 row(a[0][k], a[1][k], a[2][k]);
    disk[k] = glm::length(row - glm::dot(row, n) * n);
  }
  Bounds bounds;
  extend_box(bounds, transformed(m, p0), radius0 * (caps[0] == Cap::round ? ball : disk));
  extend_box(bounds, transformed(m, p1), radius1 * (caps[1] == Cap::round ? ball : disk));
  return bounds;
}

void check_ends(const dvec3& p0, const dvec3& p1, const std::string& what, ShapeCheck& report) {
  if (!is_finite(p0) || !is_finite(p1))
    report.error(what + "'s ends are not finite");
  else if (glm::vec3(p0) == glm::vec3(p1))
    report.error(what + " has no axis: its ends are the same point as 32-bit floats");
}

Cap drawn_cap(Draws& draws) {
  return draws.one_in(2) ? Cap::flat : draws.one_in(2) ? Cap::round : Cap::open;
}

}  // namespace

// --- Capsules ---

Bounds bounds_under(const CapsulesShape& capsules, const glm::dmat4& m) {
  Bounds bounds;
  const dvec3 unit = row_lengths(glm::dmat3(m));
  for (std::size_t i = 0; i < capsules.p0.size(); ++i) {
    const double r0 = static_cast<double>(capsules.radius0[i]);
    const double r1 = capsules.radius1.empty() ? r0 : static_cast<double>(capsules.radius1[i]);
    extend_box(bounds, transformed(m, dvec3(capsules.p0[i])), r0 * unit);
    extend_box(bounds, transformed(m, dvec3(capsules.p1[i])), r1 * unit);
  }
  return bounds;
}

void check(const CapsulesShape& capsules, ShapeCheck& report) {
  const std::size_t all = capsules.p0.size(), count = count_of(capsules);
  if (capsules.p1.size() != all || capsules.radius0.size() != all ||
      (!capsules.radius1.empty() && capsules.radius1.size() != all) ||
      (!capsules.materials.empty() && capsules.materials.size() != count) ||
      (!capsules.u.empty() && capsules.u.size() != count))
    return report.error("the capsules' lists differ in length");
  if (!check_key_times(capsules.times, all, report)) return;
  for (std::size_t i = 0; i < all; ++i) {
    const float r0 = capsules.radius0[i], r1 = capsules.radius1.empty() ? r0 : capsules.radius1[i];
    const auto capsule = [i, count] { return "capsule " + std::to_string(i % count); };
    if (!is_finite(capsules.p0[i]) || !is_finite(capsules.p1[i]) || !std::isfinite(r0) ||
        !std::isfinite(r1))
      return report.error(capsule() + " is not finite");
    if (r0 < 0 || r1 < 0) return report.error(capsule() + " has a negative radius");
    if (i >= count) continue;
    if (!capsules.u.empty() && !(is_finite(capsules.u[i]) && std::abs(capsules.u[i].x) <= 1e18f &&
                                 std::abs(capsules.u[i].y) <= 1e18f))
      return report.error(capsule() + "'s u is not finite or beyond 1e18");
    if (!capsules.materials.empty() && capsules.materials[i] >= report.materials())
      return report.error(capsule() + " has a material that does not exist");
  }
}

Beyond beyond(const CapsulesShape& capsules, const dvec3& p) {
  const double r0 = static_cast<double>(capsules.radius0[0]);
  const double r1 = capsules.radius1.empty() ? r0 : static_cast<double>(capsules.radius1[0]);
  return beyond_ends(p, dvec3(capsules.p0[0]), dvec3(capsules.p1[0]), {r0, true}, {r1, true});
}

CapsulesShape drawn(std::type_identity<CapsulesShape>, Draws& draws) {
  CapsulesShape out;
  for (int i = 0; i < 6; ++i) {
    out.p0.push_back(draws.point());
    out.p1.push_back(draws.one_in(6) ? out.p0.back() : draws.point());
    out.radius0.push_back(static_cast<float>(draws.thin()));
    out.radius1.push_back(draws.one_in(2) ? out.radius0.back() : static_cast<float>(draws.thin()));
    if (draws.sort == 0) continue;
    const double u0 = draws.uniform(-1, 2), u1 = draws.one_in(6) ? u0 : draws.uniform(-1, 2);
    out.u.emplace_back(u0, u1);
  }
  return out;
}

// --- Cylinders ---

Bounds bounds_under(const CylinderShape& c, const glm::dmat4& m) {
  return bounds_of_ends(c.p0, c.p1, c.radius, c.radius, c.caps, m);
}

void check(const CylinderShape& c, ShapeCheck& report) {
  report.positive(c.radius, "the cylinder's radius");
  check_ends(c.p0, c.p1, "the cylinder", report);
}

Beyond beyond(const CylinderShape& c, const dvec3& p) {
  return beyond_ends(p, c.p0, c.p1, {c.radius, c.caps[0] == Cap::round},
                     {c.radius, c.caps[1] == Cap::round});
}

CylinderShape drawn(std::type_identity<CylinderShape>, Draws& draws) {
  return CylinderShape{
      dvec3(draws.point()), dvec3(0), draws.thin(), {drawn_cap(draws), drawn_cap(draws)}};
}

// --- Cones ---

Bounds bounds_under(const ConeShape& c, const glm::dmat4& m) {
  return bounds_of_ends(c.p0, c.p1, c.radius[0], c.radius[1], c.caps, m);
}

void check(const ConeShape& c, ShapeCheck& report) {
  for (const double radius : c.radius)
    if (!(radius >= 0 && std::isfinite(radius)))
      return report.error("the cone's radii must be from 0 up and finite");
  report.positive(std::max(c.radius[0], c.radius[1]), "the greater of the cone's radii");
  check_ends(c.p0, c.p1, "the cone", report);
}

Beyond beyond(const ConeShape& c, const dvec3& p) {
  return beyond_ends(p, c.p0, c.p1, {c.radius[0], c.caps[0] == Cap::round},
                     {c.radius[1], c.caps[1] == Cap::round});
}

ConeShape drawn(std::type_identity<ConeShape>, Draws& draws) {
  return ConeShape{dvec3(draws.point()),
                   dvec3(0),
                   {draws.thin(), draws.one_in(3) ? 0 : draws.thin()},
                   {drawn_cap(draws), drawn_cap(draws)}};
}

}  // namespace caplet
