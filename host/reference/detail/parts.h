// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Private to this room: what the shapes' files tell primitive.cpp.
#pragma once

#include "reference/primitive.h"

namespace caplet::reference {

double distance_to_segment(const glm::dvec3& x, const glm::dvec3& a, const glm::dvec3& b);

// spool.cpp
double value_of(const Spool& spool, const glm::dvec3& x);
double hull_value(const Spool& spool, const glm::dvec3& x);  // signed, as if all ends were closed
SurfaceAt surface_of(const Spool& spool, const glm::dvec3& x);
double distance_from(const Spool& spool, const glm::dvec3& x, int surface);
glm::dvec3 normal_of(const Spool& spool, const glm::dvec3& x, int surface);
std::vector<Curve> boundary_of(const Spool& spool);
// Where the side of normal n (one of side_normals) touches an end: along and across the axis.
glm::dvec2 side_contact(const Spool& spool, std::size_t end, const glm::dvec2& n);
glm::dvec3 any_perpendicular(const glm::dvec3& unit);

// planes.cpp
double value_of(const Box& box, const glm::dvec3& x);
double value_of(const Polyhedron& polyhedron, const glm::dvec3& x);
SurfaceAt surface_of(const Box& box, const glm::dvec3& x);
SurfaceAt surface_of(const Polyhedron& polyhedron, const glm::dvec3& x);
double distance_from(const Box& box, const glm::dvec3& x, int surface);
double distance_from(const Polyhedron& polyhedron, const glm::dvec3& x, int surface);
glm::dvec3 normal_of(const Box& box, int surface);
glm::dvec3 normal_of(const Polyhedron& polyhedron, int surface);

// open.cpp
double value_of(const PartialSphere& sphere, const glm::dvec3& x);
double value_of(const OpenCylinder& cylinder, const glm::dvec3& x);
double value_of(const PartialDisk& disk, const glm::dvec3& x);
bool keeps_of(const PartialSphere& sphere, const glm::dvec3& x);
bool keeps_of(const OpenCylinder& cylinder, const glm::dvec3& x);
bool keeps_of(const PartialDisk& disk, const glm::dvec3& x);
std::vector<Curve> boundary_of(const PartialSphere& sphere);
std::vector<Curve> boundary_of(const OpenCylinder& cylinder);
std::vector<Curve> boundary_of(const PartialDisk& disk);

// bilinear.cpp
double value_of(const Bilinear& patch, const glm::dvec3& x);
glm::dvec2 parameters_of(const Bilinear& patch, const glm::dvec3& x);  // of the point nearest to x
glm::dvec3 normal_of(const Bilinear& patch, const glm::dvec3& x);

// csg.cpp
double value_of(const Csg& csg, const glm::dvec3& x);
SurfaceAt surface_of(const Csg& csg, const glm::dvec3& x);
double distance_from(const Csg& csg, const glm::dvec3& x, int surface);
Ball ball_of(const Csg& csg);

}  // namespace caplet::reference
