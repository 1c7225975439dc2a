// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Finds points on surfaces with the reference, along random lines through a primitive, so that no
// shape needs code here.
#include "verify/rays.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <limits>

#include "lower/camera.h"

namespace caplet::verify {

namespace {

using glm::dvec3;

dvec3 perpendicular(const dvec3& n, Random& random) {
  for (;;) {
    const dvec3 v = glm::cross(n, random.direction());
    if (glm::length(v) > 1e-3) return glm::normalize(v);
  }
}

bool is_usable(const RayRecord& r) {
  float largest = 0;
  for (const float x : {r.ox, r.oy, r.oz, r.dx, r.dy, r.dz}) {
    if (!std::isfinite(x)) return false;
  }
  for (const float x : {r.dx, r.dy, r.dz}) largest = std::max(largest, std::abs(x));
  // The kernels do not support directions whose squares overflow or vanish (docs/numerics.md).
  return largest > 0x1p-50f && largest < 0x1p50f;
}

}  // namespace

RayRecord ray_record(const dvec3& o, const dvec3& d) {
  return {static_cast<float>(o.x), static_cast<float>(o.y),
          static_cast<float>(o.z), 0,
          static_cast<float>(d.x), static_cast<float>(d.y),
          static_cast<float>(d.z), std::numeric_limits<float>::infinity()};
}

/// A point on a primitive's surface, in its space.
struct RaySource::Point {
  dvec3 at, normal;  // unit
  double size;  // of the primitive near the point: the length of a chord, at most the ball's radius
};

RaySource::RaySource(const Scene& scene, const reference::SceneReference& reference,
                     std::uint64_t seed)
    : scene_(scene), reference_(reference), seed_(seed), by_kind_(reference::kind_names.size()) {
  for (std::size_t i = 0; i < reference.size(); ++i)
    by_kind_[reference::kind_of(reference.placed(i).primitive)].push_back(i);
  std::erase_if(by_kind_, [](const auto& primitives) { return primitives.empty(); });
}

/// Returns a random primitive. All kinds are equally likely, whatever their numbers of primitives.
std::size_t RaySource::primitive(Random& random) const {
  const auto& primitives = by_kind_[random.below(by_kind_.size())];
  return primitives[random.below(primitives.size())];
}

RaySource::Point RaySource::surface_point(std::size_t index, Random& random) const {
  const auto placed = reference_.placed(index);
  const reference::Ball& ball = placed.ball;
  Point out{ball.center, random.direction(), ball.radius};
  for (int attempt = 0; attempt < 12; ++attempt) {
    // Thin shapes are hit along lines through two points of the ball, the second of which is drawn
    // near the centre.
    const dvec3 a = ball.center + ball.radius * random.in_ball();
    const dvec3 b = ball.center + ball.radius * std::pow(random.unit(), 3.0) * random.direction();
    const reference::Ray line{a, b - a, -HUGE_VAL, HUGE_VAL};
    const auto crossings = reference::crossings(placed.primitive, line);
    if (crossings.empty()) continue;
    const std::size_t k = random.below(crossings.size());
    out.at = a + crossings[k].t * line.direction;
    if (crossings.size() > 1)
      out.size = std::min(ball.radius,
                          (crossings.back().t - crossings.front().t) * glm::length(line.direction));
    out.size = std::max(out.size, 1e-6 * ball.radius);
    const dvec3 n = reference::normal_at(placed.primitive, out.at, 1e-6 * out.size);
    if (std::isfinite(n.x) && std::isfinite(n.y) && std::isfinite(n.z)) out.normal = n;
    break;
  }
  return out;
}

/// Returns a point where two surfaces of a shape meet, or on the boundary of an open shape.
std::optional<RaySource::Point> RaySource::rim(std::size_t index, Random& random) const {
  const auto placed = reference_.placed(index);
  if (const auto curves = reference::boundary(placed.primitive);
      !curves.empty() && (reference::surface_count(placed.primitive) == 1 || random.one_in(2))) {
    const reference::Curve& curve = curves[random.below(curves.size())];
    return Point{curve.at(random.one_in(8) ? static_cast<double>(random.below(2)) : random.unit()),
                 random.direction(), placed.ball.radius};
  }
  const Point a = surface_point(index, random), b = surface_point(index, random);
  const int surface = reference::surface_at(placed.primitive, a.at).surface;
  if (reference::surface_at(placed.primitive, b.at).surface == surface) return std::nullopt;
  // Bisection along the segment between the points, projected from the ball's centre, finds where
  // the surface changes.
  const dvec3 from = placed.ball.center;
  double low = 0, high = 1;
  Point out = a;
  for (int i = 0; i < 48; ++i) {
    const double middle = 0.5 * (low + high);
    const dvec3 aim = a.at + middle * (b.at - a.at);
    if (aim == from) return std::nullopt;
    const auto crossings = reference::crossings(placed.primitive, {from, aim - from, 0, HUGE_VAL});
    if (crossings.empty()) return std::nullopt;
    out.at = from + crossings.back().t * (aim - from);
    (crossings.back().surface == surface ? low : high) = middle;
  }
  return out;
}

RayRecord RaySource::camera_ray(Random& random) const {
  const FilmSettings& film = scene_.view.film;
  return ray_of_pixel(scene_, static_cast<int>(random.below(static_cast<std::size_t>(film.width))),
                      static_cast<int>(random.below(static_cast<std::size_t>(film.height))));
}

RayRecord RaySource::chord(Random& random) const {
  const auto point = [&] {
    const auto placed = reference_.placed(primitive(random));
    const dvec3 local = placed.ball.center + placed.ball.radius * random.in_ball();
    return dvec3(glm::inverse(placed.object_from_world) * glm::dvec4(local, 1));
  };
  const dvec3 a = point(), b = point();
  return ray_record(random.one_in(2) ? a : a - random.uniform(0, 2) * (b - a),
                    glm::normalize(b - a) * random.power(-2, 2));
}

std::optional<RayRecord> RaySource::bounce(Random& random) const {
  const RayRecord first = random.one_in(3) ? camera_ray(random) : chord(random);
  if (!is_usable(first)) return std::nullopt;
  const reference::Ray ray{{first.ox, first.oy, first.oz}, {first.dx, first.dy, first.dz}};
  const auto hit = reference_.closest(ray);
  if (!hit) return std::nullopt;
  const dvec3 at = ray.origin + hit->t * ray.direction;
  dvec3 n = reference_.normal(*hit, at);
  if (!std::isfinite(n.x + n.y + n.z)) return std::nullopt;
  if (glm::dot(n, ray.direction) > 0) n = -n;
  const dvec3 d = n + random.direction();
  if (glm::length(d) < 1e-6) return std::nullopt;
  return ray_record(at + n * (0x1p-18 * (glm::length(at) + 1e-6)), d);
}

std::optional<RayRecord> RaySource::hard(RayFamily family, Random& random) const {
  const std::size_t index = primitive(random);
  const auto placed = reference_.placed(index);
  std::optional<Point> p =
      family == RayFamily::rim ? rim(index, random) : surface_point(index, random);
  if (!p) return std::nullopt;
  const dvec3 tangent = perpendicular(p->normal, random);
  const double size = p->size;
  dvec3 o, d;
  switch (family) {
    case RayFamily::touching: {
      const double beside = random.one_in(3) ? 0 : random.sign() * random.power(-8, -1);
      d = tangent;
      o = p->at + beside * size * p->normal - random.uniform(0.1, 4) * size * d;
      break;
    }
    case RayFamily::grazing:
      d = tangent + random.sign() * random.power(-6, -1) * p->normal;
      o = p->at - random.uniform(0.01, 10) * size * d;
      break;
    case RayFamily::far:
      d = random.direction();
      o = p->at - placed.ball.radius * random.power(1, 6) * d;
      break;
    case RayFamily::inside:
      o = p->at - size * random.power(-4, 0) * p->normal;
      d = random.direction();
      break;
    case RayFamily::on_surface:
      o = p->at;
      d = random.direction();
      break;
    default:  // to the point, or beside it
      d = random.direction();
      o = p->at + (random.one_in(2) ? 0 : random.power(-6, 0)) * size * random.direction() -
          random.uniform(0.01, 10) * size * d;
  }
  const glm::dmat4 world = glm::inverse(placed.object_from_world);
  dvec3 origin(world * glm::dvec4(o, 1)), direction(world * glm::dvec4(d, 0));
  if (family == RayFamily::axis) {
    const dvec3 at(world * glm::dvec4(p->at, 1));
    direction = dvec3(random.one_in(2) ? 0.0 : -0.0);
    direction[static_cast<int>(random.below(3))] = random.sign();
    origin = at - random.uniform(0, 4) * glm::length(origin - at) * direction;
  }
  return ray_record(origin, glm::normalize(direction) * random.power(-3, 3));
}

VerifyRay RaySource::ray(std::uint64_t index) const {
  Random random(seed_, 0, index);
  // Two rays in sixteen come from the camera, three are bounces, two are chords, and the others are
  // hard.
  constexpr std::array<RayFamily, 16> turns = {
      RayFamily::camera,   RayFamily::camera,  RayFamily::bounce,  RayFamily::bounce,
      RayFamily::bounce,   RayFamily::chord,   RayFamily::chord,   RayFamily::touching,
      RayFamily::touching, RayFamily::grazing, RayFamily::grazing, RayFamily::rim,
      RayFamily::axis,     RayFamily::far,     RayFamily::inside,  RayFamily::on_surface};
  VerifyRay out;
  out.family = turns[index % turns.size()];
  for (int attempt = 0; attempt < 8; ++attempt) {
    const std::optional<RayRecord> made =
        out.family == RayFamily::camera   ? std::optional(camera_ray(random))
        : out.family == RayFamily::bounce ? bounce(random)
        : out.family == RayFamily::chord  ? std::optional(chord(random))
                                          : hard(out.family, random);
    if (made && is_usable(*made)) {
      out.ray = *made;
      return out;
    }
  }
  // No surface to bounce from, or a shape without rims, gives a chord.
  out.family = RayFamily::chord;
  for (int attempt = 0; attempt < 8; ++attempt)
    if (out.ray = chord(random); is_usable(out.ray)) return out;
  out.ray = ray_record(dvec3(0), dvec3(0, 0, 1));
  return out;
}

}  // namespace caplet::verify
