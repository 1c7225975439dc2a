// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include "scene/shapes/family.h"

namespace caplet {

/// A disk of `radius` in the plane z = height, normal +z. As in pbrt it may have a hole of
/// `inner_radius` and end at `phi_max`.
struct DiskShape {
  double height = 0;
  double radius = 1;
  double inner_radius = 0;
  double phi_max = full_turn;  // radians, from +x towards +y

  bool is_whole() const { return inner_radius == 0 && phi_max >= full_turn; }
};

inline std::size_t count_of(const DiskShape&) { return 1; }
inline std::size_t surfaces_of(const DiskShape&) { return 1; }
inline bool closed(const DiskShape&) { return false; }
inline Beyond beyond(const DiskShape&, const glm::dvec3&) { return unknown; }

inline void check(const DiskShape& disk, ShapeCheck& report) {
  report.positive(disk.radius, "the disk's radius");
  if (!std::isfinite(disk.height)) report.error("the disk's height is not finite");
  if (disk.radius > 0 && !(disk.inner_radius >= 0 && disk.inner_radius < disk.radius))
    report.error("the disk's inner radius must be from 0 up and below its radius");
  if (!(disk.phi_max > 0)) report.error("the disk's greatest phi must be above 0");
}

inline Bounds bounds_under(const DiskShape& disk, const glm::dmat4& m) {
  return bounds_along_rows(m, [&](const glm::dvec3& a) {
    const double across = greatest_across(a, disk.phi_max);
    return across * (across >= 0 ? disk.radius : disk.inner_radius) + a.z * disk.height;
  });
}

/// Random disks are whole or partial.
template <>
inline constexpr int drawn_sorts<DiskShape> = 2;
inline DiskShape drawn(std::type_identity<DiskShape>, Draws& draws) {
  const double r = draws.size;
  if (draws.sort == 0) return DiskShape{draws.uniform(-1, 1), r, 0, full_turn};
  return DiskShape{draws.uniform(-1, 1), r, (1 - draws.thin()) * r, draws.angle};
}

}  // namespace caplet
