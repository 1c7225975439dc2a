// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Finds crossings of a ray with any shape of primitive.h, in double. Convex solids use interval
// subdivision of the implicit function along the ray (it is convex there, and 1-Lipschitz), then
// bisection; open parts of them use the same, and the predicate that clips. Triangles use signed
// volumes, disks plane and radius, bilinear patches subdivision until the patch, seen along the
// ray, does not fold. The boundary of csg shapes lies in the operands' boundaries, so between
// successive crossings of those the sign of the value at one point says where the ray is.
#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "reference/primitive.h"

namespace caplet::reference {

/// Ray is the points origin + t * direction with t_min < t < t_max; `direction` of any length.
struct Ray {
  glm::dvec3 origin{0}, direction{0, 0, 1};
  double t_min = 0, t_max = std::numeric_limits<double>::infinity();
};

struct Crossing {
  double t = 0;
  bool leaving = false;  // from inside to outside; open surfaces: along the normal
  int surface = 0;
  double surface_margin =
      0;  // how far (at least) the crossing may be displaced before it lies on another surface
};

/// Returns every crossing of the whole line (all t) in order: two for a convex solid, entering and
/// leaving in turn for csg shapes. Solids and gaps of csg shapes thinner than 1e-10 of the shape
/// along the ray are not seen. Rays that are not finite or have no direction miss.
std::vector<Crossing> crossings(const Primitive& primitive, const Ray& ray);

/// Returns the first crossing with t_min < t < t_max.
std::optional<Crossing> closest(const Primitive& primitive, const Ray& ray);

/// Returns how far the line through the ray may be displaced before a hit becomes a miss or the
/// other way: > 0 the line hits, < 0 it misses. For solids it is minus the least value() along the
/// line. For open surfaces it is the distance to where the number of crossings changes: between the
/// line and the boundary curves, and to tangency.
double margin(const Primitive& primitive, const Ray& ray);

/// Returns whether margin() is within the tolerance of 0; faster than that for open surfaces.
bool comes_within(const Primitive& primitive, const Ray& ray, double tolerance);

enum class Verdict { hit, miss, tangent };

/// Says by dense sampling of value() along the line, without assumptions on its shape, whether the
/// line enters the solid deeper than `tolerance`, stays further away than that, or neither. For
/// open surfaces it uses margin().
Verdict referee(const Primitive& primitive, const Ray& ray, double tolerance);

}  // namespace caplet::reference
