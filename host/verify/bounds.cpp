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

double stretch_of(const dmat4& m) {
  double squares = 0;
  for (int c = 0; c < 3; ++c) squares += glm::dot(dvec3(m[c]), dvec3(m[c]));
  return std::sqrt(squares);
}

// Returns an upper bound of the distance from `center` to the corners of the boxes around all
// solids of a csg shape.
double furthest_corner(const reference::Csg& csg, const dvec3& center, const dmat4& outer_from_csg,
                       double stretch) {
  double out = 0;
  for (const reference::CsgOperand& operand : csg.body->operands) {
    const dmat4 csg_from_operand = glm::inverse(operand.operand_from_csg),
                outer = outer_from_csg * csg_from_operand;
    const double own_stretch = stretch * stretch_of(csg_from_operand);
    if (const auto* nested = std::get_if<reference::Csg>(&operand.primitive)) {
      out = std::max(out, furthest_corner(*nested, center, outer, own_stretch));
    } else {
      const reference::Ball ball = reference::bounding_ball(operand.primitive);
      out = std::max(out, glm::length(dvec3(outer * glm::dvec4(ball.center, 1)) - center) +
                              std::sqrt(3.0) * own_stretch * ball.radius);
    }
  }
  return out;
}

// The kernels' stated bound for a ray from a distance D of the primitive's ball (docs/numerics.md),
// in multiples of eps. Every size in the bounds is at most twice the ball's radius R and every |o -
// p0| at most D + R: a factor of D + 3 R. A molecular patch may be a small part of its sphere or
// torus, whose own size counts. For csg shapes it is 3 D + 16 (R + 3 e), and half as much
// again for operands in spaces of their own; R is that of the shape's box and e the distance of the
// furthest corner of an operand's.
double bound_of(const reference::Primitive& primitive, const reference::Ball& ball, double corner,
                double distance) {
  if (std::holds_alternative<reference::Csg>(primitive))
    return 3 * distance + 24 * (std::sqrt(3.0) * ball.radius + 3 * corner);
  double size = ball.radius;
  if (const auto* patch = std::get_if<reference::MolecularPatch>(&primitive))
    size += patch->major + patch->minor + glm::length(patch->center - ball.center);
  return (std::holds_alternative<reference::Bilinear>(primitive) ? 24 : 16) * (distance + 3 * size);
}

double altitude(const dvec3& a, const dvec3& b, const dvec3& c) {
  const double longest = std::max({glm::length(b - a), glm::length(c - b), glm::length(a - c)});
  return glm::length(glm::cross(b - a, c - a)) / longest;
}

// The angle by which a plane or axis turns when the points that span it move by `moved`: the
// quotient by their least extent.
double tilt_of(const reference::Primitive& primitive, double moved);

struct TiltOf {
  double moved;
  double operator()(const reference::Capsule& c) const {
    // The shorter it is, the closer it is to a ball.
    const double length = glm::length(c.p1 - c.p0);
    return length > 0 ? std::min(moved / length, 2 * length / std::max(c.radius0, c.radius1)) : 0;
  }
  double operator()(const reference::Frustum& s) const { return moved / s.length; }
  double operator()(const reference::Triangle& t) const {
    const double extent = glm::length(t.v1 - t.v0) + glm::length(t.v2 - t.v0);
    return (moved + 4 * eps * extent) / altitude(t.v0, t.v1, t.v2);
  }
  double operator()(const reference::Bilinear& b) const {
    const double extent = glm::length(b.p11 - b.p00) + glm::length(b.p10 - b.p01);
    const double least = std::min({altitude(b.p00, b.p10, b.p01), altitude(b.p10, b.p11, b.p00),
                                   altitude(b.p01, b.p00, b.p11), altitude(b.p11, b.p01, b.p10)});
    return (moved + 4 * eps * extent) / least;
  }
  double operator()(const reference::Csg& csg) const {
    double out = 0;
    for (const reference::CsgOperand& operand : csg.body->operands)
      out = std::max(out, tilt_of(operand.primitive, moved * operand.stretch));
    return out;
  }
  template <class Model>
  double operator()(const reference::Solid<Model>& solid) const {
    return tilt_of(solid.shape, moved);
  }
  // These are balls, and planes whose normals are given.
  double operator()(const reference::Sphere&) const { return 0; }
  double operator()(const reference::Disk&) const { return 0; }
  double operator()(const reference::Polyhedron&) const { return 0; }
  double operator()(const reference::PartialSphere&) const { return 0; }
  double operator()(const reference::OpenCylinder&) const { return 0; }
  double operator()(const reference::PartialDisk&) const { return 0; }
  double operator()(const reference::MolecularPatch&) const { return 0; }
};

double tilt_of(const reference::Primitive& primitive, double moved) {
  return std::visit(TiltOf{moved}, primitive);
}

}  // namespace

Bounds::Bounds(const reference::SceneReference& reference, bool is_moving)
    : reference_(&reference), matrix_roundings_(is_moving ? 4 : 0) {
  places_.reserve(reference.size());
  for (std::size_t i = 0; i < reference.size(); ++i) {
    const auto placed = reference.placed(i);
    const dmat4 back = glm::inverse(placed.object_from_world);
    const double world_stretch = stretch_of(back);
    const auto* csg = std::get_if<reference::Csg>(&placed.primitive);
    places_.push_back({stretch_of(placed.object_from_world), world_stretch,
                       glm::length(dvec3(back[3])) +
                           world_stretch * (glm::length(placed.ball.center) + placed.ball.radius),
                       glm::length(dvec3(placed.object_from_world[3])),
                       csg ? furthest_corner(*csg, placed.ball.center, dmat4(1), 1) : 0});
  }
}

// The bound includes the kernels' own and the transform into the primitive's space: the matrices'
// entries are rounded (1), and multiplied and added (3); the numbers of baked shapes are rounded in
// the world (1). Six times eps of all terms, as large as they get anywhere on the primitive, is
// more than both.
LocalRay Bounds::local(std::size_t primitive, const reference::Ray& ray) const {
  const auto placed = reference_->placed(primitive);
  const Place& place = places_[primitive];
  const dmat4& m = placed.object_from_world;
  LocalRay out{
      &placed.primitive,
      {dvec3(m * glm::dvec4(ray.origin, 1)), dvec3(m * glm::dvec4(ray.direction, 0)), 0, HUGE_VAL},
      0};
  const double distance = glm::length(out.ray.origin - placed.ball.center);
  const double terms =
      place.object_stretch * (glm::length(ray.origin) + place.world_size) + place.object_shift;
  out.bound = eps * (bound_of(placed.primitive, placed.ball, place.corner, distance) +
                     (6 + matrix_roundings_) * terms);
  return out;
}

double Bounds::rounding(std::size_t primitive) const {
  const Place& place = places_[primitive];
  return (4 + matrix_roundings_) * eps *
         (place.world_size + place.world_stretch * place.object_shift);
}

double Bounds::tilt(std::size_t primitive) const {
  const Place& place = places_[primitive];
  // Both ends of a span move.
  return condition(primitive) * tilt_of(reference_->placed(primitive).primitive,
                                        2 * rounding(primitive) * place.object_stretch);
}

}  // namespace caplet::verify
