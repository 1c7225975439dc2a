// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "brute.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "shared/kinds.h"

namespace caplet::test {
namespace {

constexpr double never = std::numeric_limits<double>::infinity();
constexpr double eps = 0x1p-24;

double dot(const Vec& a, const Vec& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vec sub(const Vec& a, const Vec& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Vec cross(const Vec& a, const Vec& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double length(const Vec& a) { return std::sqrt(dot(a, a)); }
Vec at(const DoubleRay& ray, double t) {
  return {ray.o[0] + t * ray.d[0], ray.o[1] + t * ray.d[1], ray.o[2] + t * ray.d[2]};
}
Vec data3(const FlatPrimitive& p, int i) {
  return {double(p.data[i]), double(p.data[i + 1]), double(p.data[i + 2])};
}

bool solid(const FlatPrimitive& p) {
  return p.shape == shape_sphere || p.shape == shape_capsule || p.shape == shape_tapered_capsule;
}

/// Spheres c0 r0 and c1 r1 whose hull the solid is.
struct Hull {
  Vec c0, c1;
  double r0, r1;
};
Hull hull(const FlatPrimitive& p) {
  const Vec c0 = data3(p, 0);
  if (p.shape == shape_sphere) return {c0, c0, double(p.data[3]), double(p.data[3])};
  return {c0, data3(p, 3), double(p.data[6]),
          double(p.shape == shape_capsule ? p.data[6] : p.data[7])};
}

/// Least of |x - c(s)| - r(s) over the sphere centres c(s) between both ends: where d/ds is 0.
double hull_distance(const Hull& h, const Vec& x) {
  const Vec axis = sub(h.c1, h.c0), w = sub(x, h.c0);
  const double l = length(axis);
  double s = h.r1 > h.r0 ? 1 : 0;  // no axis: the larger sphere
  if (l > 0) {
    const double along = dot(w, axis) / l;
    const Vec across = {w[0] - along * axis[0] / l, w[1] - along * axis[1] / l,
                        w[2] - along * axis[2] / l};
    const double k = (h.r1 - h.r0) / l;
    if (std::abs(k) >= 1)
      s = k > 0 ? 1 : 0;
    else
      s = std::clamp((along + length(across) * k / std::sqrt(1 - k * k)) / l, 0.0, 1.0);
  }
  const Vec c = {h.c0[0] + s * axis[0], h.c0[1] + s * axis[1], h.c0[2] + s * axis[2]};
  return length(sub(x, c)) - (h.r0 + s * (h.r1 - h.r0));
}

struct Span {
  double enter = never, exit = -never;
};

/// Where the ray is deeper than `depth` in the hull (negative depth: the hull grown).
Span span_of(const Hull& h, const DoubleRay& ray, double depth) {
  const auto value = [&](double t) { return hull_distance(h, at(ray, t)) + depth; };
  const double speed = length(ray.d);
  const double middle = -dot(sub(ray.o, h.c0), ray.d) / dot(ray.d, ray.d);
  const double reach =
      (length(sub(h.c1, h.c0)) + 2 * std::max(h.r0, h.r1) + std::abs(depth)) / speed;
  double a = middle - reach, b = middle + reach;
  double low = a, high = b;
  for (int i = 0; i < 120; i++) {
    const double t1 = low + (high - low) * 0.45, t2 = low + (high - low) * 0.55;
    (value(t1) < value(t2) ? high : low) = value(t1) < value(t2) ? t2 : t1;
  }
  const double deepest = 0.5 * (low + high);
  if (!(value(deepest) < 0)) return {};
  Span span;
  double out = a, in = deepest;
  for (int i = 0; i < 70; i++) {
    const double t = 0.5 * (out + in);
    (value(t) < 0 ? in : out) = t;
  }
  span.enter = in;
  out = b;
  in = deepest;
  for (int i = 0; i < 70; i++) {
    const double t = 0.5 * (out + in);
    (value(t) < 0 ? in : out) = t;
  }
  span.exit = in;
  return span;
}

/// Inward distances of x, projected to the plane, from the three edges' lines.
std::array<double, 3> edge_distances(const FlatPrimitive& p, const Vec& normal, const Vec& x) {
  std::array<double, 3> out{};
  for (int e = 0; e < 3; e++) {
    const Vec a = data3(p, 3 * e), b = data3(p, 3 * ((e + 1) % 3));
    const Vec inward = cross(normal, sub(b, a));
    out[static_cast<std::size_t>(e)] = dot(inward, sub(x, a)) / length(inward);
  }
  return out;
}

Vec triangle_normal(const FlatPrimitive& p) {
  const Vec n = cross(sub(data3(p, 3), data3(p, 0)), sub(data3(p, 6), data3(p, 0)));
  const double l = length(n);
  return {n[0] / l, n[1] / l, n[2] / l};
}

double size_of(const FlatPrimitive& p) {
  switch (p.shape) {
    case shape_sphere:
      return double(p.data[3]);
    case shape_disk:
      return double(p.data[6]);
    case shape_triangle:
      return std::max(length(sub(data3(p, 3), data3(p, 0))), length(sub(data3(p, 6), data3(p, 0))));
    default: {
      const Hull h = hull(p);
      return length(sub(h.c1, h.c0)) + h.r0 + h.r1;
    }
  }
}

}  // namespace

DoubleRay widen(const RayRecord& r) {
  return {{double(r.ox), double(r.oy), double(r.oz)},
          {double(r.dx), double(r.dy), double(r.dz)},
          double(r.t_min),
          double(r.t_max)};
}

double surface_distance(const FlatPrimitive& p, const Vec& x) {
  if (solid(p)) return hull_distance(hull(p), x);
  if (p.shape == shape_disk) {
    const Vec n = data3(p, 3), w = sub(x, data3(p, 0));
    const double off = dot(w, n), across = std::sqrt(std::max(0.0, dot(w, w) - off * off));
    return std::max(std::abs(off), across - double(p.data[6]));
  }
  const Vec n = triangle_normal(p);
  const auto edges = edge_distances(p, n, x);
  return std::max({std::abs(dot(n, sub(x, data3(p, 0)))), -edges[0], -edges[1], -edges[2]});
}

double claimed_error(const FlatPrimitive& p, const DoubleRay& ray) {
  return 16 * eps * (length(sub(ray.o, data3(p, 0))) + size_of(p));
}

double latest_hit(const FlatPrimitive& p, const DoubleRay& ray, double error) {
  if (solid(p)) {
    const Hull h = hull(p);
    const double reach = length(sub(h.c1, h.c0)) + std::max(h.r0, h.r1) + error;
    const Vec w = sub(h.c0, ray.o);
    if (length(cross(w, ray.d)) > reach * length(ray.d)) return never;
    const Span deep = span_of(h, ray, error);
    if (deep.enter > ray.t_min) return deep.enter;
    return deep.exit > ray.t_min ? span_of(h, ray, -error).exit : never;
  }
  const Vec n = p.shape == shape_disk ? data3(p, 3) : triangle_normal(p);
  const double along = dot(ray.d, n);
  if (std::abs(along) < 1e-9 * length(ray.d)) return never;
  const double t = dot(sub(data3(p, 0), ray.o), n) / along;
  const double slack = error / std::abs(along);         // in t
  const double margin = error + slack * length(ray.d);  // in the plane
  const Vec x = at(ray, t);
  if (!(t - slack > ray.t_min)) return never;
  if (p.shape == shape_disk)
    return length(sub(x, data3(p, 0))) < double(p.data[6]) - margin ? t + slack : never;
  const auto edges = edge_distances(p, n, x);
  return std::min({edges[0], edges[1], edges[2]}) > margin ? t + slack : never;
}

std::string disagreement(std::span<const FlatPrimitive> primitives,
                         std::span<const std::uint32_t> slots, const RayRecord& record,
                         const HitRecord& hit) {
  const DoubleRay ray = widen(record);
  const double t = hit.slot == CAPLET_NONE ? never : double(hit.t);
  if (hit.slot != CAPLET_NONE) {
    if (!(hit.t > record.t_min && hit.t < record.t_max))
      return fmt::format("t {} outside ({}, {})", t, ray.t_min, ray.t_max);
    const auto found = std::find(slots.begin(), slots.end(), hit.slot);
    if (found == slots.end()) return fmt::format("slot {} belongs to no primitive", hit.slot);
    const FlatPrimitive& p = primitives[static_cast<std::size_t>(found - slots.begin())];
    // Grazing an open shape, a point off the plane by `error` is off the rim by error / cos; the
    // plane is checked alone then.
    const double error = claimed_error(p, ray);
    const double distance = surface_distance(p, at(ray, t));
    if (std::abs(distance) > error)
      return fmt::format("point at t {} is {} off shape {}, the bound is {}", t, distance, p.shape,
                         error);
    if (solid(p)) {
      const bool leaving = (hit.surface >> 16 & 1u) != 0;
      const Span inside = span_of(hull(p), ray, 0);
      const double middle = 0.5 * (inside.enter + inside.exit);
      const double depth = -hull_distance(hull(p), at(ray, middle));
      if (inside.enter < inside.exit && depth > 2 * error && leaving != (t > middle))
        return fmt::format("leaving is {} at t {} of the span {} to {}", leaving, t, inside.enter,
                           inside.exit);
    }
  }
  for (std::size_t i = 0; i < primitives.size(); i++) {
    const double latest = latest_hit(primitives[i], ray, claimed_error(primitives[i], ray));
    if (t > latest && latest < ray.t_max)
      return fmt::format("reported t {} but primitive {} (shape {}) is hit by t {} at the latest",
                         t, i, primitives[i].shape, latest);
  }
  return {};
}

}  // namespace caplet::test
