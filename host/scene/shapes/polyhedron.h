// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <vector>

#include "scene/shapes/family.h"

namespace caplet {

inline constexpr std::size_t max_polyhedron_planes =
    1024;  // 32 in a csg still have their surfaces numbered in 16 bits
/// The points x with normals[i] . (x - points[i]) <= 0 for all i. It is bounded and has an inside.
/// Surface i lies in plane i.
struct PolyhedronShape {
  std::vector<glm::dvec3> points, normals;  // outward, of any length
};

/// Returns the corners of each face in order around it (counter-clockwise from outside), in object
/// space. Planes that only touch the solid, miss it or repeat an earlier one have fewer than three.
/// The result is empty when the polyhedron is unbounded or wider than a million times the spread of
/// its points (treated as unbounded), has no inside, or is thinner than 1e-7 of that spread.
/// `bad_plane` is then the first plane at fault: degenerate, leaving nothing inside the earlier
/// ones, or with an unbounded face. Time grows with the square of the number of planes:
/// milliseconds for some hundred.
std::vector<std::vector<glm::dvec3>> polyhedron_faces(const PolyhedronShape& polyhedron,
                                                      std::size_t* bad_plane = nullptr);

/// Returns every corner once; otherwise as polyhedron_faces.
std::vector<glm::dvec3> polyhedron_corners(const PolyhedronShape& polyhedron,
                                           std::size_t* bad_plane = nullptr);

inline std::size_t count_of(const PolyhedronShape&) { return 1; }
inline std::size_t surfaces_of(const PolyhedronShape& polyhedron) {
  return polyhedron.points.size();
}
inline bool closed(const PolyhedronShape&) { return true; }
/// The bounds are empty when polyhedron_corners is.
Bounds bounds_under(const PolyhedronShape& polyhedron, const glm::dmat4& m);
void check(const PolyhedronShape& polyhedron, ShapeCheck& report);
Beyond beyond(const PolyhedronShape& polyhedron, const glm::dvec3& p);
PolyhedronShape drawn(std::type_identity<PolyhedronShape>, Draws& draws);

}  // namespace caplet
