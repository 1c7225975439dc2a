// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Crossings of a ray with any shape of primitive.h, in double. Solids: interval subdivision of the implicit function along the
// ray (it is convex there, and 1-Lipschitz), then bisection. Triangles by signed volumes, disks by plane and radius.
#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "reference/primitive.h"

namespace caplet::reference {

/// Points origin + t * direction with t_min < t < t_max; `direction` of any length.
struct Ray {
  glm::dvec3 origin{0}, direction{0, 0, 1};
  double t_min = 0, t_max = std::numeric_limits<double>::infinity();
};

struct Crossing {
  double t = 0;
  bool leaving = false;  // from inside to outside; false for open surfaces
};

/// Every crossing of the whole line (all t) in order: two for a solid, one for an open surface, none for a miss. Rays that are
/// not finite or have no direction miss.
std::vector<Crossing> crossings(const Primitive& primitive, const Ray& ray);

/// The first crossing with t_min < t < t_max.
std::optional<Crossing> closest(const Primitive& primitive, const Ray& ray);

/// How far the line through the ray may be displaced before hitting becomes missing or the other way: > 0 the line hits, < 0 it
/// misses. Solids: minus the least value() along the line. Open surfaces: distance between the line and the boundary curve.
double margin(const Primitive& primitive, const Ray& ray);

enum class Verdict { hit, miss, tangent };

/// Says by dense sampling of value() along the line, which assumes nothing of its shape, whether it enters the solid deeper than
/// `tolerance`, stays further away than that, or neither. For open surfaces: by margin().
Verdict referee(const Primitive& primitive, const Ray& ray, double tolerance);

}  // namespace caplet::reference
