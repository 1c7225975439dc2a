// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// pbrt's partial spheres and tubes around the z axis.
#pragma once

#include "scene/shapes/family.h"

namespace caplet {

/// A part of a sphere around the origin, as in pbrt: z_min <= z <= z_max, 0 <= phi <= phi_max. It
/// is open.
struct PartialSphereShape {
  double radius = 1, z_min = -1, z_max = 1, phi_max = full_turn;
};

/// pbrt's cylinder around the z axis: a tube or a part of one. It is open.
struct OpenCylinderShape {
  double radius = 1, z_min = -1, z_max = 1, phi_max = full_turn;
};

template <class Part>
void check_part(const Part& part, const std::string& what, ShapeCheck& report) {
  report.positive(part.radius, (what + "'s radius").c_str());
  if (!(part.z_min < part.z_max && std::isfinite(part.z_max - part.z_min)))
    report.error(what + " must end at a greater z than it begins at");
  if (!(part.phi_max > 0 && part.phi_max <= full_turn))
    report.error(what + "'s greatest phi must be above 0 and at most a full turn");
}

inline std::size_t count_of(const PartialSphereShape&) { return 1; }
inline std::size_t surfaces_of(const PartialSphereShape&) { return 1; }
inline bool closed(const PartialSphereShape&) { return false; }
inline Beyond beyond(const PartialSphereShape&, const glm::dvec3&) { return unknown; }
inline void check(const PartialSphereShape& sphere, ShapeCheck& report) {
  check_part(sphere, "the sphere", report);
}

inline Bounds bounds_under(const PartialSphereShape& s, const glm::dmat4& m) {
  // At height z the sphere has the radius rho = sqrt(r^2 - z^2), and a.p is at most a_z z + across
  // rho. This is concave in z with its maximum at r a_z / |(across, a_z)| where across >= 0;
  // otherwise it is convex.
  return bounds_along_rows(m, [&](const glm::dvec3& a) {
    const double across = greatest_across(a, s.phi_max);
    const auto at = [&](double z) {
      return a.z * z + across * std::sqrt(std::max(0.0, s.radius * s.radius - z * z));
    };
    const double slope = std::hypot(across, a.z);
    if (across < 0 || slope == 0) return std::max(at(s.z_min), at(s.z_max));
    return at(std::clamp(s.radius * a.z / slope, s.z_min, s.z_max));
  });
}

inline PartialSphereShape drawn(std::type_identity<PartialSphereShape>, Draws& draws) {
  const double r = draws.size, z = draws.uniform(-0.9, 0.5);
  return PartialSphereShape{r, z * r, draws.uniform(z + 0.1, 1) * r, draws.angle};
}

inline std::size_t count_of(const OpenCylinderShape&) { return 1; }
inline std::size_t surfaces_of(const OpenCylinderShape&) { return 1; }
inline bool closed(const OpenCylinderShape&) { return false; }
inline Beyond beyond(const OpenCylinderShape&, const glm::dvec3&) { return unknown; }
inline void check(const OpenCylinderShape& cylinder, ShapeCheck& report) {
  check_part(cylinder, "the cylinder", report);
}

inline Bounds bounds_under(const OpenCylinderShape& c, const glm::dmat4& m) {
  return bounds_along_rows(m, [&](const glm::dvec3& a) {
    return c.radius * greatest_across(a, c.phi_max) + std::max(a.z * c.z_min, a.z * c.z_max);
  });
}

inline OpenCylinderShape drawn(std::type_identity<OpenCylinderShape>, Draws& draws) {
  return OpenCylinderShape{draws.thin(), -draws.size, 0.7 * draws.size, draws.angle};
}

}  // namespace caplet
