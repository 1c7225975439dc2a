// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "verify/bounds.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace caplet::verify {

namespace {

using glm::dmat4;
using glm::dvec3;

constexpr double eps = 0x1p-24;

double stretch_of(const dmat4& m) {
  double squares = 0;
  for (int c = 0; c < 3; ++c) squares += glm::dot(dvec3(m[c]), dvec3(m[c]));
  return std::sqrt(squares);
}

// The greatest multiple of eps in docs/numerics.md's bound of a kind. Of csg shapes 64 for what holds near them: 16 eps
// (R + 3 e), where e is at most R.
double factor_of(const reference::Primitive& primitive) {
  if (std::holds_alternative<reference::Csg>(primitive)) return 64;
  return std::holds_alternative<reference::Bilinear>(primitive) ? 24 : 16;
}

double altitude(const dvec3& a, const dvec3& b, const dvec3& c) {
  const double longest = std::max({glm::length(b - a), glm::length(c - b), glm::length(a - c)});
  return glm::length(glm::cross(b - a, c - a)) / longest;
}

// Points that move by `moved` turn what they span by as much over its least extent.
double tilt_of(const reference::Primitive& primitive, double moved);

struct TiltOf {
  double moved;
  double operator()(const reference::Capsule& c) const {
    // The shorter it is, the more it is a ball.
    const double length = glm::length(c.p1 - c.p0);
    return length > 0 ? std::min(moved / length, 2 * length / std::max(c.radius0, c.radius1)) : 0;
  }
  double operator()(const reference::Spool& s) const { return moved / s.length; }
  double operator()(const reference::Triangle& t) const {
    const double extent = glm::length(t.v1 - t.v0) + glm::length(t.v2 - t.v0);
    return (moved + 4 * eps * extent) / altitude(t.v0, t.v1, t.v2);
  }
  double operator()(const reference::Bilinear& b) const {
    const double extent = glm::length(b.p11 - b.p00) + glm::length(b.p10 - b.p01);
    const double least = std::min({altitude(b.p00, b.p10, b.p01), altitude(b.p10, b.p11, b.p00), altitude(b.p01, b.p00, b.p11),
                                   altitude(b.p11, b.p01, b.p10)});
    return (moved + 4 * eps * extent) / least;
  }
  double operator()(const reference::Csg& csg) const {
    double out = 0;
    for (const reference::CsgOperand& operand : csg.body->operands)
      out = std::max(out, tilt_of(operand.primitive, moved * operand.stretch));
    return out;
  }
  template <class Other>
  double operator()(const Other&) const {
    return 0;  // balls, and planes whose normals are given
  }
};

double tilt_of(const reference::Primitive& primitive, double moved) { return std::visit(TiltOf{moved}, primitive); }

}  // namespace

Bounds::Bounds(const reference::SceneWitness& witness) : witness_(&witness) {
  places_.reserve(witness.size());
  for (std::size_t i = 0; i < witness.size(); ++i) {
    const auto placed = witness.placed(i);
    const dmat4 back = glm::inverse(placed.object_from_world);
    const double world_stretch = stretch_of(back);
    places_.push_back({stretch_of(placed.object_from_world), world_stretch,
                       glm::length(dvec3(back[3])) + world_stretch * (glm::length(placed.ball.center) + placed.ball.radius),
                       glm::length(dvec3(placed.object_from_world[3]))});
  }
}

// In the primitive's space, with the distance D of the origin from its ball's centre and the ball's radius R: every size of the
// kernels' bounds is at most 2 R and every |o - p0| at most D + R, so those are at most factor (D + 3 R). The way there: the
// matrices' entries are rounded (1), and multiplied and added (3); of baked shapes the own numbers are rounded in the world (1).
// Six times eps of all terms, as large as they get anywhere on the primitive, is more than both.
LocalRay Bounds::local(std::size_t primitive, const reference::Ray& ray) const {
  const auto placed = witness_->placed(primitive);
  const Place& place = places_[primitive];
  const dmat4& m = placed.object_from_world;
  LocalRay out{
      &placed.primitive, {dvec3(m * glm::dvec4(ray.origin, 1)), dvec3(m * glm::dvec4(ray.direction, 0)), 0, HUGE_VAL}, 0};
  const double distance = glm::length(out.ray.origin - placed.ball.center);
  const double terms = place.object_stretch * (glm::length(ray.origin) + place.world_size) + place.object_shift;
  out.bound = eps * (factor_of(placed.primitive) * (distance + 3 * placed.ball.radius) + 6 * terms);
  return out;
}

double Bounds::rounding(std::size_t primitive) const {
  const Place& place = places_[primitive];
  return 4 * eps * (place.world_size + place.world_stretch * place.object_shift);
}

double Bounds::tilt(std::size_t primitive) const {
  const Place& place = places_[primitive];
  // Both ends of what is spanned move.
  return condition(primitive) * tilt_of(witness_->placed(primitive).primitive, 2 * rounding(primitive) * place.object_stretch);
}

}  // namespace caplet::verify
