// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// These are the reference implementation's shapes, in double precision, each stated from its
// definition. Solids are the set where an implicit function is <= 0; open surfaces are part of a
// solid's boundary or of a plane, with the predicate that clips it. No formula here solves for a
// ray: solver.h does, the same way for every shape.
#pragma once

#include <array>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "scene/shape.h"

namespace caplet::reference {

inline constexpr double full_turn = 6.283185307179586;

struct Sphere {
  glm::dvec3 center{0};
  double radius = 1;
};
/// A Capsule is the union of the balls whose centre and radius go linearly from (p0, radius0) to
/// (p1, radius1): the convex hull of two spheres.
struct Capsule {
  glm::dvec3 p0{0}, p1{0, 0, 1};
  double radius0 = 1, radius1 = 1;
  std::optional<glm::dvec2> u = {};  // of chains: at p0 and p1
};
struct Triangle {
  glm::dvec3 v0, v1, v2;
};
/// `normal` need not be of unit length.
struct Disk {
  glm::dvec3 center{0}, normal{0, 0, 1};
  double radius = 1;
};

/// A Frustum is a cylinder or cone: the convex hull of two ends, each a disk across the axis or a
/// ball. Surfaces: 0 the side, which touches both ends; 1 and 2 the points that belong to the end
/// at p0 or p1 alone. `open`: that surface is not there, and the shape is no solid. make_frustum
/// makes it.
struct Frustum {
  struct End {
    double radius = 1;
    bool round = false, open = false;
  };
  glm::dvec3 p0{0}, p1{0, 0, 1};
  std::array<End, 2> ends;
  // These are made from the above: the axis, and the normals (along the axis, outward) of the
  // planes that touch both ends.
  glm::dvec3 axis{0, 0, 1};
  double length = 1;
  std::array<glm::dvec2, 2> side_normals;
  int side_count = 0;
};
Frustum make_frustum(const glm::dvec3& p0, const glm::dvec3& p1, const Frustum::End& end0,
                     const Frustum::End& end1);

/// Solid is a convex solid as the model's own surfaces bound it (caplet::FacedSolid), for kinds
/// that have no shape of their own here.
template <class Model>
struct Solid {
  Model shape;
};
using Box = Solid<BoxShape>;

/// A Polyhedron is normals[i] . (x - center) <= offsets[i] for all i; surface i lies in plane i.
/// make_polyhedron makes it.
struct Polyhedron {
  glm::dvec3 center{0};
  std::vector<glm::dvec3> normals;  // unit
  std::vector<double> offsets;
  std::vector<glm::dvec3> corners;  // each as often as edges end there
  glm::dvec3 ball_center{0};        // of a ball that holds them
  double ball_radius = 0;
};
/// Makes a polyhedron. The normals may be of any length (offsets along with them). Unbounded or
/// empty sets have no corners and a ball of no meaning.
Polyhedron make_polyhedron(const glm::dvec3& center, std::span<const glm::dvec3> normals,
                           std::span<const double> offsets);

// These are open shapes around the z axis, as pbrt's: the part of the sphere of `radius`, of the
// tube or of the disk with z_min <= z <= z_max and an angle from +x towards +y of at most phi_max.
struct PartialSphere {
  double radius = 1, z_min = -1, z_max = 1, phi_max = full_turn;
};
struct OpenCylinder {
  double radius = 1, z_min = -1, z_max = 1, phi_max = full_turn;
};
/// Its normal is +z.
struct PartialDisk {
  double height = 0, radius = 1, inner_radius = 0, phi_max = full_turn;
};

/// The patch is (1-u)(1-v) p00 + u(1-v) p10 + (1-u)v p01 + uv p11, 0 <= u, v <= 1. Its normal is
/// dp/du x dp/dv.
struct Bilinear {
  glm::dvec3 p00, p10, p01, p11;
};

/// A MolecularPatch is part of the surface that a probe cannot pass: of a sphere (major radius 0),
/// within planes, or of the inner side of a torus. The molecule is within the spheres of balls, and
/// outside those of probes and the tubes of tori. Its normal points out of the molecule.
struct MolecularPatch {
  struct Plane {
    glm::dvec3 normal;  // unit
    double offset = 0;  // normal . (x - center) <= offset
  };
  glm::dvec3 center{0};
  double minor = 1, major = 0;
  bool of_probe = false;
  std::vector<Plane> planes;
  // Tori have these too; SurfacePatches::TorusPatch says what they mean.
  glm::dvec3 axis{0, 0, 1}, start{1, 0, 0};
  double phi_max = full_turn, theta_min = 0, theta_max = 0;
  glm::dvec3 ball_center{0};  // of a ball that holds it
  double ball_radius = 0;
};

/// A Csg combines solids, nested to any depth. Surface numbers of the operands follow each other.
/// make_csg makes it.
struct CsgBody;
struct Csg {
  enum class Operation {
    set_union,
    set_intersection,
    set_difference
  } operation = Operation::set_union;
  std::shared_ptr<const CsgBody> body;
};

using Primitive = VariantBehind<void
#define PRIMITIVE(Type) , Type
#include "reference/primitives.def"
                                >;

struct CsgOperand {
  Primitive primitive;
  glm::dmat4 operand_from_csg{1};
  double stretch = 1;  // greatest length of an operand_from_csg'd unit vector
  int surface_begin = 0;
};
struct CsgBody {
  std::vector<CsgOperand> operands;
  glm::dvec3 ball_center{0};  // of a ball that holds the shape
  double ball_radius = 0;
};
struct CsgPart {
  Primitive primitive;
  glm::dmat4 csg_from_operand{1};
};
/// Makes a csg shape of at least one part, all solids.
Csg make_csg(Csg::Operation operation, std::span<const CsgPart> parts);

/// SurfaceAt is the surface that a point on (or next to) a solid's boundary belongs to, and how far
/// (at least) one may go from there before it is another one.
struct SurfaceAt {
  int surface = 0;
  double margin = 0;
};
/// Ball is a ball that holds the shape.
struct Ball {
  glm::dvec3 center;
  double radius;
};

/// Curve is a curve in space, over [0, 1].
struct Curve {
  enum class Kind { segment, arc } kind = Kind::segment;
  glm::dvec3 p,
      q;  // segment: the ends; arc: p + radius (cos a, sin a) in the plane of q and r (unit,
          // orthogonal), a from `from` to `to`
  glm::dvec3 r{0};
  double radius = 0, from = 0, to = 0;
  glm::dvec3 at(double s) const;
};

}  // namespace caplet::reference
