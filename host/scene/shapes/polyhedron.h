// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <vector>

#include "scene/shapes/family.h"

namespace caplet {

inline constexpr std::size_t max_polyhedron_planes = 1024;  // 32 in a csg still have their surfaces numbered in 16 bits
/// The points x with normals[i] . (x - points[i]) <= 0 for all i: bounded, with an inside. Surface i lies in plane i.
struct PolyhedronShape {
  std::vector<glm::dvec3> points, normals;  // outward, of any length
};

/// Corners of each face of a polyhedron in order around it (counter-clockwise from outside), object space; fewer than three for
/// planes that only touch the solid, stay clear of it or repeat an earlier one. Empty when the polyhedron is unbounded, further
/// across than a million times the spread of its points (unbounded, so to speak), has no inside, or is thinner than 1e-7 of that
/// spread. `bad_plane`: then the first plane to blame (a degenerate one, the one that leaves nothing inside the earlier ones, or
/// one whose face has no end). Time: square of the number of planes, milliseconds for some hundred.
std::vector<std::vector<glm::dvec3>> polyhedron_faces(const PolyhedronShape& polyhedron, std::size_t* bad_plane = nullptr);

/// Every corner once; the same otherwise.
std::vector<glm::dvec3> polyhedron_corners(const PolyhedronShape& polyhedron, std::size_t* bad_plane = nullptr);

inline std::size_t count_of(const PolyhedronShape&) { return 1; }
inline std::size_t surfaces_of(const PolyhedronShape& polyhedron) { return polyhedron.points.size(); }
inline bool closed(const PolyhedronShape&) { return true; }
/// Empty when polyhedron_corners is.
Bounds bounds_under(const PolyhedronShape& polyhedron, const glm::dmat4& m);
void check(const PolyhedronShape& polyhedron, ShapeCheck& report);
Beyond beyond(const PolyhedronShape& polyhedron, const glm::dvec3& p);
PolyhedronShape drawn(std::type_identity<PolyhedronShape>, Draws& draws);

}  // namespace caplet
