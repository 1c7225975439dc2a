// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Capsules, cylinders and cones: convex hulls of two ends.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "scene/shapes/family.h"

namespace caplet {

/// Capsules (p0, p1, one radius) and tapered capsules (two radii): the convex hull of two spheres
/// each. All vectors have one entry per capsule. `radius1` is empty when no capsule is tapered.
/// `materials` is empty or holds an index into Scene::materials per capsule (overriding
/// Shape::material). `u` is empty, or holds u at p0 and at p1 of each capsule of a chain, which
/// then has the uv of pbrt's curves (docs/shapes.md, "Chains").
///
/// Capsules that move have `times`, two or more that rise (seconds). p0, p1, radius0 and radius1
/// then hold all capsules at the first time, then all at the second one, and so on.
struct CapsulesShape {
  std::vector<glm::vec3> p0, p1;
  std::vector<float> radius0, radius1;
  std::vector<std::uint32_t> materials;
  std::vector<glm::vec2> u = {};
  std::vector<double> times = {};
};

/// The ends of a cylinder or cone. The solid is the convex hull of its two ends: flat ones are
/// disks across the axis, round ones balls of the end's radius. Rays pass through an open end,
/// which is otherwise flat; the shape is then no solid.
enum class Cap { flat, round, open };

/// Surfaces: 0 side, 1 the cap at p0, 2 the cap at p1.
struct CylinderShape {
  glm::dvec3 p0{0, 0, 0}, p1{0, 0, 1};
  double radius = 1;
  std::array<Cap, 2> caps{Cap::flat, Cap::flat};
};

/// A frustum where both caps are flat; one radius may be 0. The surfaces are numbered as the
/// cylinder's.
struct ConeShape {
  glm::dvec3 p0{0, 0, 0}, p1{0, 0, 1};
  std::array<double, 2> radius{1, 0};
  std::array<Cap, 2> caps{Cap::flat, Cap::flat};
};

inline std::size_t count_of(const CapsulesShape& capsules) {
  return capsules.times.empty() ? capsules.p0.size() : capsules.p0.size() / capsules.times.size();
}
inline std::size_t surfaces_of(const CapsulesShape&) { return 1; }
inline bool closed(const CapsulesShape&) { return true; }
/// Bounds them at all times.
Bounds bounds_under(const CapsulesShape& capsules, const glm::dmat4& m);
void check(const CapsulesShape& capsules, ShapeCheck& report);
Beyond beyond(const CapsulesShape& capsules, const glm::dvec3& p);  // only the first capsule
/// Random capsules are drawn without u and with it.
CapsulesShape drawn(std::type_identity<CapsulesShape>, Draws& draws);
template <>
inline constexpr int drawn_sorts<CapsulesShape> = 2;

inline std::size_t count_of(const CylinderShape&) { return 1; }
inline std::size_t surfaces_of(const CylinderShape&) { return 3; }
inline bool closed(const CylinderShape& c) {
  return c.caps[0] != Cap::open && c.caps[1] != Cap::open;
}
Bounds bounds_under(const CylinderShape& cylinder, const glm::dmat4& m);
void check(const CylinderShape& cylinder, ShapeCheck& report);
Beyond beyond(const CylinderShape& cylinder, const glm::dvec3& p);
CylinderShape drawn(std::type_identity<CylinderShape>, Draws& draws);

inline std::size_t count_of(const ConeShape&) { return 1; }
inline std::size_t surfaces_of(const ConeShape&) { return 3; }
inline bool closed(const ConeShape& c) { return c.caps[0] != Cap::open && c.caps[1] != Cap::open; }
Bounds bounds_under(const ConeShape& cone, const glm::dmat4& m);
void check(const ConeShape& cone, ShapeCheck& report);
Beyond beyond(const ConeShape& cone, const glm::dvec3& p);
ConeShape drawn(std::type_identity<ConeShape>, Draws& draws);

}  // namespace caplet
