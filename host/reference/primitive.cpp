// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Distances to the shapes.
#include "reference/primitive.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "reference/detail/parts.h"

namespace caplet::reference {

using glm::dvec3;

double distance_to_segment(const dvec3& x, const dvec3& a, const dvec3& b) {
  const dvec3 ab = b - a;
  const double squared = glm::dot(ab, ab);
  const double s = squared > 0 ? std::clamp(glm::dot(x - a, ab) / squared, 0.0, 1.0) : 0.0;
  return glm::length(x - (a + s * ab));
}

namespace {

double value_of(const Sphere& s, const dvec3& x) { return glm::length(x - s.center) - s.radius; }

// The least of |x - c(s)| - r(s) over the balls of the hull. With y along the axis and rho across it, that is convex in s and has
// no slope where (s L - y) / |x - c(s)| = k, the growth of the radius by length: s L = y + rho k / sqrt(1 - k^2).
double value_of(const Capsule& c, const dvec3& x) {
  const dvec3 axis = c.p1 - c.p0, w = x - c.p0;
  const double growth = c.radius1 - c.radius0, squared = glm::dot(axis, axis);
  const auto at = [&](double s) { return glm::length(w - s * axis) - (c.radius0 + s * growth); };
  // One ball holds the other.
  if (growth * growth >= squared) return at(growth > 0 ? 1 : 0);
  const double along = glm::dot(w, axis) / squared;
  const double across = glm::length(w - along * axis);
  return at(std::clamp(along + across * growth / std::sqrt(squared * (squared - growth * growth)), 0.0, 1.0));
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
Ball ball_of(const Spool& s) { return {0.5 * (s.p0 + s.p1), 0.5 * s.length + std::max(s.ends[0].radius, s.ends[1].radius)}; }
Ball ball_of(const Box& b) { return {0.5 * (b.min + b.max), 0.5 * glm::length(b.max - b.min)}; }
Ball ball_of(const Polyhedron& p) { return {p.ball_center, p.ball_radius}; }
Ball ball_of(const PartialSphere& s) { return {dvec3(0), s.radius}; }
Ball ball_of(const OpenCylinder& c) {
  return {dvec3(0, 0, 0.5 * (c.z_min + c.z_max)), std::hypot(c.radius, 0.5 * (c.z_max - c.z_min))};
}
Ball ball_of(const PartialDisk& d) { return {dvec3(0, 0, d.height), d.radius}; }
Ball ball_of(const Bilinear& b) {
  const dvec3 center = 0.25 * (b.p00 + b.p10 + b.p01 + b.p11);
  double radius = 0;
  for (const dvec3* corner : {&b.p00, &b.p10, &b.p01, &b.p11}) radius = std::max(radius, glm::length(*corner - center));
  return {center, radius};
}

template <class... Kinds>
bool is_any(const Primitive& p) {
  return (std::holds_alternative<Kinds>(p) || ...);
}

}  // namespace

std::size_t kind_of(const Primitive& primitive) {
  if (const auto* capsule = std::get_if<Capsule>(&primitive)) return capsule->radius0 == capsule->radius1 ? 1 : 2;
  if (const auto* spool = std::get_if<Spool>(&primitive)) return spool->ends[0].radius == spool->ends[1].radius ? 5 : 6;
  if (is_any<Sphere>(primitive)) return 0;
  if (is_any<Triangle>(primitive)) return 3;
  if (is_any<Disk>(primitive)) return 4;
  return primitive.index() - Primitive(Box{}).index() + 7;  // in the order of Primitive
}

bool is_solid(const Primitive& primitive) {
  if (const auto* spool = std::get_if<Spool>(&primitive)) return !spool->ends[0].open && !spool->ends[1].open;
  return is_any<Sphere, Capsule, Box, Polyhedron, Csg>(primitive);
}

int surface_count(const Primitive& primitive) {
  if (const auto* p = std::get_if<Polyhedron>(&primitive)) return static_cast<int>(p->normals.size());
  if (const auto* csg = std::get_if<Csg>(&primitive)) {
    const CsgOperand& last = csg->body->operands.back();
    return last.surface_begin + surface_count(last.primitive);
  }
  return is_any<Spool>(primitive) ? 3 : is_any<Box>(primitive) ? 6 : 1;
}

double value(const Primitive& primitive, const dvec3& x) {
  return std::visit([&](const auto& shape) { return value_of(shape, x); }, primitive);
}

SurfaceAt surface_at(const Primitive& primitive, const dvec3& x) {
  if (const auto* spool = std::get_if<Spool>(&primitive)) return surface_of(*spool, x);
  if (const auto* box = std::get_if<Box>(&primitive)) return surface_of(*box, x);
  if (const auto* polyhedron = std::get_if<Polyhedron>(&primitive)) return surface_of(*polyhedron, x);
  if (const auto* csg = std::get_if<Csg>(&primitive)) return surface_of(*csg, x);
  return {0, HUGE_VAL};
}

double distance_from_surface(const Primitive& primitive, const dvec3& x, int surface) {
  if (surface < 0 || surface >= surface_count(primitive)) return HUGE_VAL;
  if (const auto* spool = std::get_if<Spool>(&primitive)) return distance_from(*spool, x, surface);
  if (const auto* box = std::get_if<Box>(&primitive)) return distance_from(*box, x, surface);
  if (const auto* polyhedron = std::get_if<Polyhedron>(&primitive)) return distance_from(*polyhedron, x, surface);
  if (const auto* csg = std::get_if<Csg>(&primitive)) return distance_from(*csg, x, surface);
  return std::abs(value(primitive, x));
}

Ball bounding_ball(const Primitive& primitive) {
  return std::visit([](const auto& shape) { return ball_of(shape); }, primitive);
}

dvec3 normal_at(const Primitive& primitive, const dvec3& x, double step) {
  if (const auto* triangle = std::get_if<Triangle>(&primitive))
    return glm::normalize(glm::cross(triangle->v1 - triangle->v0, triangle->v2 - triangle->v0));
  if (const auto* disk = std::get_if<Disk>(&primitive)) return glm::normalize(disk->normal);
  if (is_any<PartialDisk>(primitive)) return {0, 0, 1};
  if (const auto* patch = std::get_if<Bilinear>(&primitive)) return normal_of(*patch, x);
  const Primitive carrier = carrier_of(primitive);
  dvec3 gradient{0};
  for (int i = 0; i < 3; ++i) {
    dvec3 e{0};
    e[i] = step;
    gradient[i] = value(carrier, x + e) - value(carrier, x - e);
  }
  return glm::normalize(gradient);
}

dvec3 normal_of_surface(const Primitive& primitive, const dvec3& x, int surface, double step) {
  if (surface >= 0 && surface < surface_count(primitive)) {
    if (const auto* spool = std::get_if<Spool>(&primitive)) return normal_of(*spool, x, surface);
    if (const auto* box = std::get_if<Box>(&primitive)) return normal_of(*box, surface);
    if (const auto* polyhedron = std::get_if<Polyhedron>(&primitive)) return normal_of(*polyhedron, surface);
  }
  return normal_at(primitive, x, step);
}

Primitive carrier_of(const Primitive& primitive) {
  if (const auto* spool = std::get_if<Spool>(&primitive)) {
    Spool closed = *spool;
    closed.ends[0].open = closed.ends[1].open = false;
    return closed;
  }
  if (const auto* sphere = std::get_if<PartialSphere>(&primitive)) return Sphere{dvec3(0), sphere->radius};
  if (const auto* c = std::get_if<OpenCylinder>(&primitive)) {
    // Longer, so that its caps are never in question.
    const double more = c->radius + 0.5 * (c->z_max - c->z_min);
    return make_spool({0, 0, c->z_min - more}, {0, 0, c->z_max + more}, {c->radius, false, false}, {c->radius, false, false});
  }
  return primitive;
}

bool keeps(const Primitive& primitive, const dvec3& x, int surface) {
  if (const auto* spool = std::get_if<Spool>(&primitive))
    return surface == 0 || !spool->ends[static_cast<std::size_t>(surface - 1)].open;
  if (const auto* sphere = std::get_if<PartialSphere>(&primitive)) return keeps_of(*sphere, x);
  if (const auto* cylinder = std::get_if<OpenCylinder>(&primitive)) return keeps_of(*cylinder, x);
  if (const auto* disk = std::get_if<PartialDisk>(&primitive)) return keeps_of(*disk, x);
  return true;
}

std::vector<Curve> boundary(const Primitive& primitive) {
  if (const auto* spool = std::get_if<Spool>(&primitive)) return boundary_of(*spool);
  if (const auto* sphere = std::get_if<PartialSphere>(&primitive)) return boundary_of(*sphere);
  if (const auto* cylinder = std::get_if<OpenCylinder>(&primitive)) return boundary_of(*cylinder);
  if (const auto* disk = std::get_if<PartialDisk>(&primitive)) return boundary_of(*disk);
  if (const auto* d = std::get_if<Disk>(&primitive)) {
    const dvec3 n = glm::normalize(d->normal), u = any_perpendicular(n);
    return {{Curve::Kind::arc, d->center, u, glm::cross(n, u), d->radius, 0, full_turn}};
  }
  const auto segment = [](const dvec3& a, const dvec3& b) { return Curve{Curve::Kind::segment, a, b, dvec3(0), 0, 0, 0}; };
  if (const auto* t = std::get_if<Triangle>(&primitive))
    return {segment(t->v0, t->v1), segment(t->v1, t->v2), segment(t->v2, t->v0)};
  if (const auto* b = std::get_if<Bilinear>(&primitive))
    return {segment(b->p00, b->p10), segment(b->p10, b->p11), segment(b->p11, b->p01), segment(b->p01, b->p00)};
  return {};
}

}  // namespace caplet::reference
