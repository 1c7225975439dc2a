// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// These are the functions of each shape's file, shapes/NAME.cpp, for primitive.cpp. A missing
// function does not link.
#pragma once

#include "reference/shapes.h"

namespace caplet::reference {

// --- For all of them ---

#define PRIMITIVE(Type)                                                  \
  double value_of(const Type& shape, const glm::dvec3& x);               \
  Ball ball_of(const Type& shape);                                       \
  glm::dvec2 uv_of(const Type& shape, const glm::dvec3& x, int surface); \
  bool has_inside(const Type& shape);
#define SOLID(Model)
#include "reference/primitives.def"

// Returns a geometry's primitives, in order, in its object space; from_scene.cpp handles those that
// are described by their surfaces.
#define GEOMETRY(Type, name) std::vector<Primitive> references_of(const Type& geometry);
#include "scene/geometries.def"

// --- uv that depend on the direction of the ray: of chains, and of csg shapes with them ---

glm::dvec2 chain_uv_of(const Capsule& capsule, const glm::dvec3& x, const glm::dvec3& direction);
glm::dvec2 csg_uv_of(const Csg& csg, const glm::dvec3& x, int surface, const glm::dvec3& direction);

// --- For shapes of more than one kind, shapes of more than one surface, and csg shapes ---

std::size_t which_kind(const Capsule& capsule);
std::size_t which_kind(const Frustum& frustum);

int surfaces_of(const Frustum& frustum);
int surfaces_of(const Polyhedron& polyhedron);
int surfaces_of(const Csg& csg);
SurfaceAt surface_of(const Frustum& frustum, const glm::dvec3& x);
SurfaceAt surface_of(const Polyhedron& polyhedron, const glm::dvec3& x);
SurfaceAt surface_of(const Csg& csg, const glm::dvec3& x);
double distance_from(const Frustum& frustum, const glm::dvec3& x, int surface);
double distance_from(const Polyhedron& polyhedron, const glm::dvec3& x, int surface);
double distance_from(const MolecularPatch& patch, const glm::dvec3& x, int surface);
double distance_from(const Csg& csg, const glm::dvec3& x, int surface);
glm::dvec3 normal_of(const Frustum& frustum, const glm::dvec3& x, int surface);
glm::dvec3 normal_of(const Polyhedron& polyhedron, const glm::dvec3& x, int surface);

// --- Sheets: the normal, the solid that they bound a part of, whether that part, and where they
// end ---

glm::dvec3 sheet_normal(const Triangle& triangle, const glm::dvec3& x);
glm::dvec3 sheet_normal(const Disk& disk, const glm::dvec3& x);
glm::dvec3 sheet_normal(const PartialDisk& disk, const glm::dvec3& x);
glm::dvec3 sheet_normal(const Bilinear& patch, const glm::dvec3& x);
glm::dvec3 sheet_normal(const MolecularPatch& patch, const glm::dvec3& x);
Primitive carrier_from(const Frustum& frustum);
Primitive carrier_from(const PartialSphere& sphere);
Primitive carrier_from(const OpenCylinder& cylinder);
Primitive carrier_from(const MolecularPatch& patch);  // the whole sphere or torus
bool keeps_of(const Frustum& frustum, const glm::dvec3& x, int surface);
bool keeps_of(const PartialSphere& sphere, const glm::dvec3& x, int surface);
bool keeps_of(const OpenCylinder& cylinder, const glm::dvec3& x, int surface);
bool keeps_of(const PartialDisk& disk, const glm::dvec3& x, int surface);
bool keeps_of(const MolecularPatch& patch, const glm::dvec3& x, int surface);
std::vector<Curve> boundary_of(const Frustum& frustum);
std::vector<Curve> boundary_of(const PartialSphere& sphere);
std::vector<Curve> boundary_of(const OpenCylinder& cylinder);
std::vector<Curve> boundary_of(const PartialDisk& disk);
std::vector<Curve> boundary_of(const Disk& disk);
std::vector<Curve> boundary_of(const Triangle& triangle);
std::vector<Curve> boundary_of(const Bilinear& patch);
std::vector<Curve> boundary_of(const MolecularPatch& patch);

// --- Convex solids as the model describes them ---

/// Greatest keeps the greatest of the surfaces' values, which one it is, and how much less the
/// others are: going d moves each by no more than d.
struct Greatest {
  double value = -HUGE_VAL, second = -HUGE_VAL;
  int surface = 0;
  void add(double distance, int number) {
    if (distance > value) {
      second = value;
      value = distance;
      surface = number;
    } else {
      second = std::max(second, distance);
    }
  }
  SurfaceAt at() const { return {surface, 0.5 * (value - second)}; }
};

template <FacedSolid Model>
int surfaces_of(const Solid<Model>& solid) {
  return static_cast<int>(caplet::surfaces_of(solid.shape));
}
template <FacedSolid Model>
Greatest greatest_of(const Solid<Model>& solid, const glm::dvec3& x) {
  Greatest out;
  for (int i = 0; i < surfaces_of(solid); ++i) out.add(outside(solid.shape, i, x), i);
  return out;
}
template <FacedSolid Model>
double value_of(const Solid<Model>& solid, const glm::dvec3& x) {
  return greatest_of(solid, x).value;
}
template <FacedSolid Model>
Ball ball_of(const Solid<Model>& solid) {
  const Bounds box = bounds_under(solid.shape, glm::dmat4(1));
  return {0.5 * (box.min + box.max), 0.5 * glm::length(box.max - box.min)};
}
template <FacedSolid Model>
glm::dvec2 uv_of(const Solid<Model>& solid, const glm::dvec3& x, int surface) {
  return uv_on(solid.shape, surface, x);
}
template <FacedSolid Model>
bool has_inside(const Solid<Model>&) {
  return true;
}
template <FacedSolid Model>
SurfaceAt surface_of(const Solid<Model>& solid, const glm::dvec3& x) {
  return greatest_of(solid, x).at();
}
template <FacedSolid Model>
double distance_from(const Solid<Model>& solid, const glm::dvec3& x, int surface) {
  return std::abs(outside(solid.shape, surface, x));
}
template <FacedSolid Model>
glm::dvec3 normal_of(const Solid<Model>& solid, const glm::dvec3& x, int surface) {
  return normal_on(solid.shape, surface, x);
}
// --- What they share ---

double distance_to_segment(const glm::dvec3& x, const glm::dvec3& a, const glm::dvec3& b);
glm::dvec3 any_perpendicular(const glm::dvec3& unit);
inline Curve segment(const glm::dvec3& a, const glm::dvec3& b) {
  return {Curve::Kind::segment, a, b, glm::dvec3(0), 0, 0, 0};
}

// frustum.cpp
double hull_value(const Frustum& frustum,
                  const glm::dvec3& x);  // signed, as if all ends were closed
// Returns where the side of normal n (one of side_normals) touches an end: along and across the
// axis.
glm::dvec2 side_contact(const Frustum& frustum, std::size_t end, const glm::dvec2& n);

// molecular_patch.cpp: negative in the molecule, as far as this carrier tells; 1-Lipschitz.
double carrier_value(const MolecularPatch& patch, const glm::dvec3& x);

// bilinear.cpp
glm::dvec2 parameters_of(const Bilinear& patch, const glm::dvec3& x);  // of the point nearest to x

}  // namespace caplet::reference
