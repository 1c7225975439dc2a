// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Nearest hit, any hit and hit list of one ray against the reference, within the bound that
// docs/numerics.md states.
#pragma once

#include <string>

#include "cases.h"

namespace caplet::test {

/// One ray in the space of its primitive, and the bound that holds there.
struct Case {
  const FlatPrimitive* primitive;
  const reference::Primitive* reference;
  reference::Ray ray;
  double bound;
  glm::dvec3 at(double t) const { return ray.origin + t * ray.direction; }
  double value(double t) const { return reference::value(*reference, at(t)); }
  /// Whether the line comes within the bound of touching, or of a rim.
  bool touches() const {
    return reference::referee(*reference, ray, bound) == reference::Verdict::tangent;
  }
};

Case make_case(const FlatPrimitive& primitive, const reference::Primitive& reference,
               const RayRecord& ray);
/// For a placed primitive, the kernel's ray in object space comes from the rounded float matrix;
/// the case's ray is exact.
Case make_case(const PlacedPrimitive& placed, const reference::Primitive& reference,
               const RayRecord& world_ray);

struct Judgement {
  std::string wrong;     // what is wrong, or empty
  bool excused = false;  // the crossings differ, and the referee says that the line touches, or it
                         // begins at the surface
  double worst = 0;      // of all crossings: distance from the surface over the bound
};
/// `listed` with a capacity of `capacity`.
Judgement judge(const Case& c, const Listed& listed, std::uint32_t capacity);

/// For solids: checks where the device says that the ray is inside, at 63 points of each stretch
/// between crossings that are further than `slack` from the surface. Returns the error, or nothing.
/// Crossings of the list alternate.
std::string wrong_way(const Case& c, const std::vector<HitRecord>& list, double slack);

/// The primitive's and the ray's bits.
std::string described(const FlatPrimitive& primitive, const RayRecord& ray);

}  // namespace caplet::test
