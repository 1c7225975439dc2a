// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// What is asked of the witness's shapes, of whichever kind.
#pragma once

#include "reference/shapes.h"

namespace caplet::reference {

/// The kinds that are told apart in reports, by name: capsules with two radii are tapered_capsules, spools are cylinders or cones
/// by theirs.
inline constexpr std::array kind_names = {
#define KIND(name) #name,
#include "reference/primitives.def"
};
/// Index into kind_names.
std::size_t kind_of(const Primitive& primitive);

/// True for shapes with an inside.
bool is_solid(const Primitive& primitive);

int surface_count(const Primitive& primitive);

/// Solids: negative inside, positive outside, 1-Lipschitz; of all but csg shapes convex. Outside the distance to the solid, but
/// for boxes and polyhedra the greatest distance to a plane, and for csg shapes what min and max make of their operands' values,
/// each divided by its `stretch`. Open surfaces: distance to the surface, never negative.
double value(const Primitive& primitive, const glm::dvec3& x);

/// Solids: the surface that a point on (or next to) the boundary belongs to.
SurfaceAt surface_at(const Primitive& primitive, const glm::dvec3& x);

/// The distance of x from what surface `surface` of a solid is part of: a whole sphere, tangent cone or plane (of csg shapes, at
/// most that distance). Where a surface goes over into the next smoothly, x may be close to both over a length that is much
/// larger than that.
double distance_from_surface(const Primitive& primitive, const glm::dvec3& x, int surface);

Ball bounding_ball(const Primitive& primitive);

/// Unit gradient of value() by central differences over `step`; for open surfaces the unit normal at the shape's point nearest to
/// x (by winding / as given / outward).
glm::dvec3 normal_at(const Primitive& primitive, const glm::dvec3& x, double step);

/// The outward unit normal of what surface `surface` is part of, a whole sphere, tangent cone or plane, at its point nearest to
/// x: beside an edge that of one side alone. Of shapes with one surface, and of csg shapes, normal_at().
glm::dvec3 normal_of_surface(const Primitive& primitive, const glm::dvec3& x, int surface, double step);

/// The solid whose boundary an open shape other than triangles, disks and patches is part of; solids are their own.
Primitive carrier_of(const Primitive& primitive);

/// True when a point on the carrier's boundary, on its surface `surface`, belongs to the shape.
bool keeps(const Primitive& primitive, const glm::dvec3& x, int surface);

/// Where an open shape ends: its rims and edges. Empty for solids.
std::vector<Curve> boundary(const Primitive& primitive);

}  // namespace caplet::reference
