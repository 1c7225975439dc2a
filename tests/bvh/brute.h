// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Rays against single primitives in double, by convexity and bisection rather than by solving
// quadratics: the distance to a convex solid is a convex function of the ray's parameter.
#pragma once

#include <array>
#include <limits>
#include <span>
#include <string>

#include "lower/encode.h"
#include "shared/records.h"

namespace caplet::test {

using Vec = std::array<double, 3>;

struct DoubleRay {
  Vec o, d;
  double t_min, t_max;
};
DoubleRay widen(const RayRecord& ray);

/// Signed distance-like: |value| is the distance of x from the primitive's surface or more,
/// negative inside (solids).
double surface_distance(const FlatPrimitive& primitive, const Vec& x);

/// The error the shape kernels claim for the distance of a reported point from the surface
/// (docs/numerics.md).
double claimed_error(const FlatPrimitive& primitive, const DoubleRay& ray);

/// The largest t a correct traversal may report because of this primitive: where the ray is deeper
/// than `error` inside it, or has certainly left it. Infinity when the primitive may be missed
/// (less than `error` of it in the way).
double latest_hit(const FlatPrimitive& primitive, const DoubleRay& ray, double error);

/// Checks one device answer against all primitives; returns an empty text or what is wrong.
std::string disagreement(std::span<const FlatPrimitive> primitives,
                         std::span<const std::uint32_t> slots, const RayRecord& ray,
                         const HitRecord& hit);

}  // namespace caplet::test
