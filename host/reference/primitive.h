// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// These functions work on the reference implementation's shapes of every kind.
#pragma once

#include "reference/shapes.h"

namespace caplet::reference {

/// These are the kinds that reports distinguish, by name: capsules with two radii are
/// tapered_capsules, frustums are cylinders or cones by theirs.
inline constexpr std::array kind_names = {
#define KIND(name) #name,
#include "reference/primitives.def"
};
/// Returns the index into kind_names.
std::size_t kind_of(const Primitive& primitive);

/// Returns true for shapes with an inside.
bool is_solid(const Primitive& primitive);

int surface_count(const Primitive& primitive);

/// For solids this is negative inside, positive outside, 1-Lipschitz, and convex except for csg
/// shapes. Outside it is the distance to the solid, but for boxes and polyhedra the greatest
/// distance to a plane, and for csg shapes what min and max make of their operands' values, each
/// divided by its `stretch`. For open surfaces it is the distance to the surface, never negative;
/// for molecular patches the greatest of those to the carrier and to the clips that it is beyond.
double value(const Primitive& primitive, const glm::dvec3& x);

/// Returns the surface that a point on (or next to) the boundary of a solid belongs to.
SurfaceAt surface_at(const Primitive& primitive, const glm::dvec3& x);

/// Returns the distance of x from the whole sphere, tangent cone or plane that surface `surface` of
/// a solid is part of (for csg shapes, at most that distance). Where a surface continues smoothly
/// into the next one, x may be close to both over a length that is much larger than that.
double distance_from_surface(const Primitive& primitive, const glm::dvec3& x, int surface);

Ball bounding_ball(const Primitive& primitive);

/// Returns the unit gradient of value() by central differences over `step`; for open surfaces the
/// unit normal at the shape's point nearest to x (by winding / as given / outward).
glm::dvec3 normal_at(const Primitive& primitive, const glm::dvec3& x, double step);

/// Returns the outward unit normal of the whole sphere, tangent cone or plane that surface
/// `surface` is part of, at its point nearest to x: beside an edge that of one side alone. For
/// shapes with one surface, and for csg shapes, it is normal_at().
glm::dvec3 normal_of_surface(const Primitive& primitive, const glm::dvec3& x, int surface,
                             double step);

/// Returns the solid whose boundary an open shape other than triangles, disks and patches is part
/// of; solids are their own.
Primitive carrier_of(const Primitive& primitive);

/// Returns true when a point on the carrier's boundary, on its surface `surface`, belongs to the
/// shape.
bool keeps(const Primitive& primitive, const glm::dvec3& x, int surface);

/// Returns where an open shape ends: its rims and edges. It is empty for solids.
std::vector<Curve> boundary(const Primitive& primitive);

}  // namespace caplet::reference
