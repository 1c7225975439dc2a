// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// These are the functions of each kind of shape in this room: lower/shapes/<name>.cpp. A missing
// function does not link.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "lower/detail/pieces.h"
#include "lower/flat_primitive.h"
#include "scene/scene.h"
#include "scene/shapes/capsule_motion.h"
#include "scene/shapes/mesh_motion.h"

namespace caplet {

/// ExactBox is a box in double, of a shape's floats.
struct ExactBox {
  std::array<double, 3> min{}, max{};
};

// Each kind of shapes.def but linked capsules has, for a primitive in the space of its tree:
// - its exact box; kinds with trait_kept_box have it in their data.
// - its area, without open ends (0 for csg shapes), and the pieces of its surface, which give areas
//   under affine maps. Bilinear and molecular patches have no pieces: bilinear_area and
// molecular_patch_area.
// - solids: itself with its surfaces moved out by `b`; data of no fixed size are appended to
// `leaves`.
#define SHAPE(name, traits)                                                                     \
  ExactBox name##_box(const FlatPrimitive& p);                                                  \
  double name##_area(const FlatPrimitive& p, const std::vector<float>& leaves);                 \
  void name##_pieces(const FlatPrimitive& p, const std::vector<float>& leaves, Pieces& pieces); \
  FlatPrimitive name##_grown(FlatPrimitive p, double b, std::vector<float>& leaves);
#define COMPOUND(name, traits)
#include "shared/shapes.def"
#undef SHAPE

/// Returns the area of a bilinear patch's image under `m`.
double bilinear_area(const float* data, const glm::dmat3& m);
/// Returns the area of a molecular patch's image under the map whose cofactor is given, to about
/// 0.01 % of the whole sphere's or torus'.
double molecular_patch_area(const float* data, const glm::dmat3& cofactor);

// Each geometry of the model has:
// - whether its kernels' form can hold the transform `m`; otherwise it becomes an instance.
// - the rotation or reflection in `m` (which it can hold), where its uv has angles around an axis;
//   otherwise 1.
// - if it is one primitive (all but capsules and meshes): that primitive under `m`, which it can
// hold;
//   the id is left 0. Data of no fixed size are appended to `leaves`.
#define GEOMETRY(Type, name)                                              \
  bool bakes_under(const Type& geometry, const glm::dmat4& m);            \
  glm::dmat3 turn_under(const Type& geometry, const glm::dmat4& m);       \
  FlatPrimitive flat_primitive(const Type& geometry, const glm::dmat4& m, \
                               std::vector<float>& leaves);
#include "scene/geometries.def"

/// Returns capsule i of `capsules` under the similarity `m` (null: none) of this scale: a sphere,
/// capsule or tapered capsule.
FlatPrimitive flat_capsule(const CapsulesShape& capsules, std::size_t i, const glm::dmat4* m,
                           double scale);

/// MovingCapsules makes primitives of capsules that move, and writes how they move to `leaves`.
class MovingCapsules {
 public:
  MovingCapsules(const CapsuleMotion& motion, std::vector<float>& leaves);
  /// Returns capsule i; what rests while the shutter is open is as flat_capsule has it.
  FlatPrimitive primitive(std::size_t i);

 private:
  const CapsuleMotion& motion_;
  std::vector<float>& leaves_;
  std::optional<CapsulesShape> resting_;
  std::uint32_t times_ = 0;  // where they are in `leaves`
};

/// Writes the segments of time of a shape's keys, up to a whole row; returns where they begin.
std::uint32_t append_key_times(const ShutterKeys& times, std::vector<float>& leaves);

/// KeyPlace is a share u, from 0 to 1, of the way from key number `segment` to the next one.
struct KeyPlace {
  std::uint32_t segment;
  float u;
};
/// Returns places between which all goes straight: those of two times in [0, 1], to the bit as
/// kernels find them (motion_segment), and the keys between them. `times`: what append_key_times
/// returned.
std::vector<KeyPlace> key_places(const std::vector<float>& leaves, std::uint32_t times,
                                 std::uint32_t segments, float begin, float end);

/// SweptBox is the box of points that go straight between places.
class SweptBox {
 public:
  /// Adds a point at a place: from `from` (at the key before) to `to` (at the next one), less and
  /// more a radius along each axis.
  void add(const float* from, const float* to, float u, float from_radius, float to_radius);
  /// Sets the kept box of a primitive.
  void keep(FlatPrimitive& p) const;

 private:
  std::array<double, 3> low_{INFINITY, INFINITY, INFINITY}, high_{-INFINITY, -INFINITY, -INFINITY};
  double largest_ = 0;
};

/// These set the kept box of a moving primitive to what it sweeps from one time to another.
void set_moving_capsule_box(FlatPrimitive& p, const std::vector<float>& leaves, float begin,
                            float end);
void set_moving_triangle_box(FlatPrimitive& p, const std::vector<float>& leaves, float begin,
                             float end);

/// MovingTriangles makes primitives of a mesh whose vertices move, and writes how they move to
/// `leaves`.
class MovingTriangles {
 public:
  MovingTriangles(const MeshMotion& motion, std::vector<float>& leaves);
  /// Returns the triangle of these three vertices.
  FlatPrimitive primitive(const std::array<std::uint32_t, 3>& corners);

 private:
  const MeshMotion& motion_;
  std::vector<float>& leaves_;
  std::uint32_t times_;  // where they are in `leaves`
};

FlatPrimitive flat_partial_disk(const DiskShape& disk);
/// Returns the patches of a molecular surface under the similarity `m`, in order.
std::vector<FlatPrimitive> flat_patches(const MolecularSurfaceShape& molecule, const glm::dmat4& m,
                                        std::vector<float>& leaves);
/// Returns the kinds of a csg primitive's operands, as shape_bit()s.
std::uint64_t csg_operand_shapes(const FlatPrimitive& csg, const std::vector<float>& leaves);
/// Returns a csg shape under `m`, as it is while the shutter of `film` is open.
FlatPrimitive flat_csg(const CsgShape& csg, const glm::dmat4& m, const FilmSettings& film,
                       std::vector<float>& leaves);
/// Returns whether an operand moves as a whole.
bool csg_moves(const FlatPrimitive& csg, const std::vector<float>& leaves);
/// Returns whether an operand is a capsule with u at its ends.
bool csg_has_chain(const FlatPrimitive& csg, const std::vector<float>& leaves);

/// Makes a primitive without data.
inline FlatPrimitive make_primitive(int shape) {
  return FlatPrimitive{static_cast<std::uint32_t>(shape), 0, {}};
}

inline glm::dvec3 point3(const float* d) { return {d[0], d[1], d[2]}; }
inline double length3(const float* a, const float* b) { return glm::length(point3(b) - point3(a)); }

/// Returns the rotation or reflection in a similarity.
glm::dmat3 turn_of_similarity(const glm::dmat4& m);

/// Adds sign * b to x in double.
inline void move_by(float& x, double sign, double b) {
  x = static_cast<float>(double(x) + sign * b);
}

inline float cap_number(Cap cap) {
  return cap == Cap::flat    ? CAPLET_CAP_FLAT
         : cap == Cap::round ? CAPLET_CAP_ROUND
                             : CAPLET_CAP_OPEN;
}

// --- Hulls of two ends: cylinders, cones and capsules (hulls.cpp) ---

ExactBox hull_box(const float* p0, const float* p1, const HullEnd& end0, const HullEnd& end1);
/// GrownHull holds the ends with the surfaces moved out by `b`.
struct GrownHull {
  glm::dvec3 p0, p1;
  double r0, r1;
};
GrownHull grown_hull(const float* p0, const float* p1, const HullEnd& end0, const HullEnd& end1,
                     double b);

}  // namespace caplet
