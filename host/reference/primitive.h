// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The witness's shapes, in double precision: what a shape is, stated from its definition. Solids are the set where an implicit
// function is <= 0; open surfaces are a plane and the predicate that clips it. No formula here solves for a ray: solver.h does,
// the same way for every shape.
#pragma once

#include <glm/vec3.hpp>
#include <variant>

namespace caplet::reference {

struct Sphere {
  glm::dvec3 center{0};
  double radius = 1;
};
/// The union of the balls whose centre and radius go linearly from (p0, radius0) to (p1, radius1): the convex hull of two
/// spheres.
struct Capsule {
  glm::dvec3 p0{0}, p1{0, 0, 1};
  double radius0 = 1, radius1 = 1;
};
struct Triangle {
  glm::dvec3 v0, v1, v2;
};
/// `normal` need not be of unit length.
struct Disk {
  glm::dvec3 center{0}, normal{0, 0, 1};
  double radius = 1;
};
using Primitive = std::variant<Sphere, Capsule, Triangle, Disk>;

/// True for shapes with an inside.
bool is_solid(const Primitive& primitive);

/// Solids: negative inside, positive outside, the distance to the solid outside; 1-Lipschitz and convex. Open surfaces: distance
/// to the surface, never negative.
double value(const Primitive& primitive, const glm::dvec3& x);

/// A ball that holds the shape.
struct Ball {
  glm::dvec3 center;
  double radius;
};
Ball bounding_ball(const Primitive& primitive);

/// Unit gradient of value() by central differences over `step`; for open surfaces the unit plane normal (by winding / as given).
glm::dvec3 normal_at(const Primitive& primitive, const glm::dvec3& x, double step);

}  // namespace caplet::reference
