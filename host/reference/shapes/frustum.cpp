// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Computes the hull of two ends through its support function h(n) = max over both ends: the signed
// distance of x is the greatest n . x - h(n) over unit normals n (exact in- and outside for any
// convex set). All is symmetric around the axis, so n and x lie in one half plane: n = (along the
// axis, outward). Each end's part of h makes n . x - h(n) a single sinusoid; its greatest value is
// at the peak of one of them, where both ends are touched, or along the axis.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "reference/detail/angles.h"
#include "reference/detail/parts.h"

namespace caplet::reference {

using glm::dvec2;
using glm::dvec3;

namespace {

// Returns the support of an end whose centre lies `along` the axis.
double support(const Frustum::End& end, double along, const dvec2& n) {
  return n.x * along + end.radius * (end.round ? 1.0 : n.y);
}

struct Profile {
  double along, across;
};
Profile profile_of(const Frustum& s, const dvec3& x) {
  const dvec3 w = x - s.p0;
  const double along = glm::dot(w, s.axis);
  return {along, glm::length(w - along * s.axis)};
}

struct Values {
  double side = -HUGE_VAL, end[2] = {-HUGE_VAL, -HUGE_VAL};
  double greatest() const { return std::max({side, end[0], end[1]}); }
};

Values values_at(const Frustum& s, const Profile& x) {
  Values out;
  // `which` becomes the end whose normal n is; its old value is used where both are touched.
  const auto value_along = [&](const dvec2& n, std::size_t* which) {
    const double h0 = support(s.ends[0], 0, n), h1 = support(s.ends[1], s.length, n);
    if (which) *which = (*which == 0 ? h1 > h0 : h1 >= h0) ? 1 : 0;
    return n.x * x.along + n.y * x.across - std::max(h0, h1);
  };
  for (int i = 0; i < s.side_count; ++i)
    out.side =
        std::max(out.side, value_along(s.side_normals[static_cast<std::size_t>(i)], nullptr));
  const auto try_end = [&](const dvec2& n, std::size_t which) {
    const double value = value_along(n, &which);
    out.end[which] = std::max(out.end[which], value);
  };
  try_end({-1, 0}, 0);
  try_end({1, 0}, 1);
  for (std::size_t i = 0; i < 2; ++i) {
    const dvec2 peak{x.along - (i == 0 ? 0 : s.length),
                     x.across - (s.ends[i].round ? 0 : s.ends[i].radius)};
    const double size = glm::length(peak);
    if (size > 0 && peak.y >= 0) try_end(peak / size, i);
    if (size == 0) try_end({0, 1}, i);
  }
  return out;
}

double distance2(const dvec2& x, const dvec2& a, const dvec2& b) {
  return distance_to_segment(dvec3(x, 0), dvec3(a, 0), dvec3(b, 0));
}

}  // namespace

dvec2 side_contact(const Frustum& s, std::size_t end, const dvec2& n) {
  const dvec2 center{end == 0 ? 0 : s.length, 0};
  return s.ends[end].round ? center + s.ends[end].radius * n
                           : center + dvec2(0, s.ends[end].radius);
}

Frustum make_frustum(const dvec3& p0, const dvec3& p1, const Frustum::End& end0,
                     const Frustum::End& end1) {
  Frustum s;
  s.p0 = p0;
  s.p1 = p1;
  s.ends = {end0, end1};
  s.length = glm::length(p1 - p0);
  s.axis = s.length > 0 ? (p1 - p0) / s.length : dvec3(0, 0, 1);
  // Both ends are touched where their supports are equal. The difference is a sinusoid of the
  // normal's angle plus a constant: monotone between its extremes.
  const auto normal = [](double angle) {
    return dvec2(std::cos(angle), std::max(0.0, std::sin(angle)));
  };
  const auto difference = [&](double angle) {
    return support(end0, 0, normal(angle)) - support(end1, s.length, normal(angle));
  };
  const double d0 = end0.round ? 0 : end0.radius, d1 = end1.round ? 0 : end1.radius;
  double extreme = std::atan2(d1 - d0, s.length);
  if (extreme < 0) extreme += pi;
  const double stations[3] = {0, extreme, pi};
  for (int i = 0; i < 2; ++i) {
    double low = stations[i], high = stations[i + 1];
    const bool low_positive = difference(low) > 0, high_positive = difference(high) > 0;
    if (low_positive == high_positive || !(low < high)) continue;
    for (;;) {
      const double middle = 0.5 * (low + high);
      if (middle <= low || middle >= high) break;
      ((difference(middle) > 0) == low_positive ? low : high) = middle;
    }
    s.side_normals[static_cast<std::size_t>(s.side_count++)] = normal(0.5 * (low + high));
  }
  return s;
}

double hull_value(const Frustum& s, const dvec3& x) {
  return values_at(s, profile_of(s, x)).greatest();
}

double value_of(const Frustum& s, const dvec3& x) {
  const Profile profile = profile_of(s, x);
  const Values values = values_at(s, profile);
  const double signed_distance = values.greatest();
  if (!s.ends[0].open && !s.ends[1].open) return signed_distance;
  // This is the distance to the surfaces that are there, each by its own line in the half plane.
  const dvec2 p{profile.along, profile.across};
  double least = HUGE_VAL;
  for (int i = 0; i < s.side_count; ++i) {
    const dvec2 n = s.side_normals[static_cast<std::size_t>(i)];
    least = std::min(least, distance2(p, side_contact(s, 0, n), side_contact(s, 1, n)));
  }
  for (std::size_t i = 0; i < 2; ++i) {
    if (s.ends[i].open) continue;
    const dvec2 center{i == 0 ? 0 : s.length, 0};
    if (!s.ends[i].round) {
      least = std::min(least, distance2(p, center, center + dvec2(0, s.ends[i].radius)));
      continue;
    }
    const dvec2 w = p - center;
    const double size = glm::length(w);
    const dvec2 n = size > 0 ? w / size : dvec2(i == 0 ? -1 : 1, 0);
    if (support(s.ends[i], center.x, n) >= support(s.ends[1 - i], i == 0 ? s.length : 0, n))
      least = std::min(least, std::abs(size - s.ends[i].radius));
  }
  return least;
}

SurfaceAt surface_of(const Frustum& s, const dvec3& x) {
  const Profile profile = profile_of(s, x);
  const Values values = values_at(s, profile);
  SurfaceAt out;
  const double greatest = values.greatest();
  out.surface = values.side == greatest ? 0 : values.end[0] == greatest ? 1 : 2;
  out.margin = HUGE_VAL;
  // Surfaces change at the circles where the side touches the ends.
  for (int i = 0; i < s.side_count; ++i)
    for (std::size_t end = 0; end < 2; ++end)
      out.margin =
          std::min(out.margin,
                   glm::length(dvec2(profile.along, profile.across) -
                               side_contact(s, end, s.side_normals[static_cast<std::size_t>(i)])));
  return out;
}

double distance_from(const Frustum& s, const dvec3& x, int surface) {
  const Profile profile = profile_of(s, x);
  const dvec2 p{profile.along, profile.across};
  double least = HUGE_VAL;
  if (surface == 0) {
    for (int i = 0; i < s.side_count; ++i) {
      const dvec2 n = s.side_normals[static_cast<std::size_t>(i)];
      least = std::min(least, std::abs(glm::dot(n, p - side_contact(s, 0, n))));
    }
    return least;
  }
  const auto end = static_cast<std::size_t>(surface - 1);
  const dvec2 center{end == 0 ? 0 : s.length, 0};
  if (s.ends[end].round) return std::abs(glm::length(p - center) - s.ends[end].radius);
  return distance2(p, center, center + dvec2(0, s.ends[end].radius));
}

dvec3 normal_of(const Frustum& s, const dvec3& x, int surface) {
  if (surface > 0) {
    const bool first = surface == 1;
    if (!s.ends[first ? 0 : 1].round) return first ? -s.axis : s.axis;
    const dvec3 w = x - (first ? s.p0 : s.p1);
    const double size = glm::length(w);
    return size > 0 ? w / size : first ? -s.axis : s.axis;
  }
  const Profile profile = profile_of(s, x);
  const dvec3 outward = x - s.p0 - profile.along * s.axis;
  const dvec3 across = profile.across > 0 ? outward / profile.across : any_perpendicular(s.axis);
  dvec2 nearest{0, 1};
  double least = HUGE_VAL;
  for (int i = 0; i < s.side_count; ++i) {
    const dvec2 n = s.side_normals[static_cast<std::size_t>(i)];
    const double away =
        std::abs(glm::dot(n, dvec2(profile.along, profile.across) - side_contact(s, 0, n)));
    if (away < least) {
      least = away;
      nearest = n;
    }
  }
  return nearest.x * s.axis + nearest.y * across;
}

std::vector<Curve> boundary_of(const Frustum& s) {
  std::vector<Curve> out;
  const dvec3 u = any_perpendicular(s.axis), v = glm::cross(s.axis, u);
  for (std::size_t end = 0; end < 2; ++end)
    for (int i = 0; i < s.side_count && s.ends[end].open; ++i) {
      const dvec2 rim = side_contact(s, end, s.side_normals[static_cast<std::size_t>(i)]);
      out.push_back({Curve::Kind::arc, s.p0 + rim.x * s.axis, u, v, rim.y, 0, full_turn});
    }
  return out;
}

bool has_inside(const Frustum& s) { return !s.ends[0].open && !s.ends[1].open; }
std::size_t which_kind(const Frustum& s) { return s.ends[0].radius == s.ends[1].radius ? 0 : 1; }
int surfaces_of(const Frustum&) { return 3; }

Ball ball_of(const Frustum& s) {
  return {0.5 * (s.p0 + s.p1), 0.5 * s.length + std::max(s.ends[0].radius, s.ends[1].radius)};
}

Primitive carrier_from(const Frustum& s) {
  Frustum closed = s;
  closed.ends[0].open = closed.ends[1].open = false;
  return closed;
}
bool keeps_of(const Frustum& s, const dvec3&, int surface) {
  return surface == 0 || !s.ends[static_cast<std::size_t>(surface - 1)].open;
}

dvec2 uv_of(const Frustum& s, const dvec3& x, int surface) {
  const OnFrustum at = on_frustum(s, x);
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
  // v runs from the pole to the circle that the side touches, or from there to the pole; whole
  // spheres run from pole to pole.
  if (s.side_count != 1) return {at.u, share(angle_from_pole(w), pi)};
  const double rim = angle_from_pole(s.side_normals[0]);
  return {at.u,
          end == 0 ? share(angle_from_pole(w), rim) : share(angle_from_pole(w) - rim, pi - rim)};
}

namespace {

Frustum::End end_of(double radius, Cap cap) {
  return {radius, cap == Cap::round, cap == Cap::open};
}

}  // namespace

std::vector<Primitive> references_of(const CylinderShape& c) {
  return {make_frustum(c.p0, c.p1, end_of(c.radius, c.caps[0]), end_of(c.radius, c.caps[1]))};
}
std::vector<Primitive> references_of(const ConeShape& c) {
  return {make_frustum(c.p0, c.p1, end_of(c.radius[0], c.caps[0]), end_of(c.radius[1], c.caps[1]))};
}

}  // namespace caplet::reference
