// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include "scene/shapes/family.h"

namespace caplet {

struct SphereShape {
  double radius = 1;  // centre at the origin
};

inline std::size_t count_of(const SphereShape&) { return 1; }
inline std::size_t surfaces_of(const SphereShape&) { return 1; }
inline bool closed(const SphereShape&) { return true; }
inline void check(const SphereShape& sphere, ShapeCheck& report) {
  report.positive(sphere.radius, "the sphere's radius");
}
inline Beyond beyond(const SphereShape& sphere, const glm::dvec3& p) {
  return Beyond::exactly(glm::length(p) - sphere.radius);
}
inline SphereShape drawn(std::type_identity<SphereShape>, Draws& draws) { return {draws.size}; }

inline Bounds bounds_under(const SphereShape& sphere, const glm::dmat4& m) {
  Bounds bounds;
  extend_box(bounds, transformed(m, glm::dvec3(0)), sphere.radius * row_lengths(glm::dmat3(m)));
  return bounds;
}

}  // namespace caplet
