// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The geometry behind Shape statements, one reader a type (docs/formats/pbrt.md). What is wrong is reported with its place, and
// something harmless is returned: the scene is then refused as a whole.
#pragma once

#include <glm/vec3.hpp>
#include <string_view>
#include <variant>

#include "import/detail/pbrt_parameters.h"
#include "scene/scene.h"

namespace caplet::pbrt {

using Geometry = decltype(Shape::geometry);

/// A number as a float; reports when it is too large for one.
float to_float(Parameters& parameters, std::string_view name, double value);
/// All points or vectors of a parameter; none when it is not there.
std::vector<glm::vec3> vectors3(Parameters& parameters, const Parameter* values);
/// One point that must be given, each coordinate at most largest_length.
glm::dvec3 required_point(Parameters& parameters, std::string_view name);
/// "float radius": one value, positive and at most largest_length.
double positive_radius(Parameters& parameters, double fallback);
/// "phimax" in radians, above 0 and at most a full turn (more is a full turn, as in pbrt).
double phi_max(Parameters& parameters);
/// A length of either sign, at most largest_length.
double length(Parameters& parameters, std::string_view name, double fallback);

/// Whole, or pbrt's part of one.
Geometry make_sphere(Parameters& parameters);
DiskShape make_disk(Parameters& parameters);
CapsulesShape make_capsule(Parameters& parameters);
/// With "p0" or "p1" ours, otherwise pbrt's open one.
Geometry make_cylinder(Parameters& parameters);
ConeShape make_cone(Parameters& parameters);
BoxShape make_box(Parameters& parameters);
PolyhedronShape make_polyhedron(Parameters& parameters);
TriangleMeshShape make_triangle_mesh(Parameters& parameters);
BilinearMeshShape make_bilinear_mesh(Parameters& parameters);
/// Chains of tapered capsules along pbrt's curve: no point of a chain's axis is further from the curve's point of the same
/// parameter than max(1e-3 of the greater width, 1e-5 of the diagonal of the control points' bounds). As radii run linearly in
/// the same parameter, that is also the Hausdorff distance of the chain from the round tube.
CapsulesShape make_curve(Parameters& parameters);
CsgShape make_csg(Parameters& parameters, const ObjectLookup& objects);

}  // namespace caplet::pbrt
