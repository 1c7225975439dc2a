// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Random primitives and rays for the shape tests: scales from 1e-3 to 1e3, coordinates up to 1e5,
// lengths up to 1e4 radii; rays that come from outside, far, inside and the surface, run along the
// axes, touch, and pass rims, edges, ends and apexes. CAPLET_TEST_SCALE=N in the environment tries
// N times as many primitives (default 1: some 20 s on two cores in all).
#pragma once

#include <glm/vec3.hpp>
#include <iosfwd>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "probe.h"
#include "scene/scene.h"
#include "support/kinds.h"
#include "support/test_scale.h"

namespace caplet::test {

struct CaseSet {
  std::vector<FlatPrimitive> primitives;
  std::vector<reference::Primitive> references;  // of each primitive
  std::vector<float> leaves;                     // for Probe
  std::vector<std::uint32_t> which;              // of each ray
  std::vector<RayRecord> rays;
  const reference::Primitive& reference(std::size_t ray) const { return references[which[ray]]; }
  const FlatPrimitive& primitive(std::size_t ray) const { return primitives[which[ray]]; }
  void renew_references();  // after changes to the primitives; not for csg shapes
};

class CaseMaker {
 public:
  explicit CaseMaker(std::uint32_t seed) : random_(seed) {}
  /// Appends a primitive. `hard`: the full range of scales; otherwise radii 0.1 to 10 near the
  /// origin.
  void add_primitive(int shape, bool hard, CaseSet& out);
  /// A primitive of a kind that needs no `leaves`.
  FlatPrimitive primitive(int shape, bool hard);
  RayRecord ray(const FlatPrimitive& primitive, const reference::Primitive& reference);
  CaseSet set(int shape, bool hard, int primitives, int rays_each);
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  int below(int n) { return std::uniform_int_distribution<int>(0, n - 1)(random_); }
  glm::dvec3 direction();  // uniform over the sphere
  /// A point of the surface, every other one on a rim, edge or end, and its outward (or stored)
  /// unit normal.
  glm::dvec3 surface_point(const FlatPrimitive& primitive, const reference::Primitive& reference,
                           glm::dvec3* normal);
  /// Where a primitive is to be, and how large.
  struct Frame {
    double r;
    glm::dvec3 center, axis;
    double length;
  };
  /// A bounded polyhedron of `planes` planes that touch the ball of `at`, stretched along its axis.
  FlatPrimitive polyhedron(int planes, double stretch, const Frame& at, std::vector<float>& leaves);
  /// A patch of some balls' surface.
  FlatPrimitive molecular_patch(const Frame& at, std::vector<float>& leaves);
  /// Along the shape's axis, or an edge.
  glm::dvec3 own_axis(const FlatPrimitive& primitive, const reference::Primitive& reference);

 private:
  Frame frame(bool hard);
  FlatPrimitive basic(int shape, bool hard, const Frame& at);
  FlatPrimitive solid(int shape, bool hard, const Frame& at);
  FlatPrimitive open(int shape, bool hard, const Frame& at);
  FlatPrimitive faced(int shape, bool hard, const Frame& at);
  Shape csg_shape(int depth);
  glm::dvec3 point_of(const reference::Frustum& frustum, glm::dvec3* normal);
  glm::dvec3 box_point(const BoxShape& box, glm::dvec3* normal);
  template <class Model>
  glm::dvec3 point_of(const reference::Solid<Model>& solid, glm::dvec3* normal);
  glm::dvec3 point_of(const reference::Polyhedron& polyhedron, glm::dvec3* normal);
  glm::dvec3 point_of(const reference::PartialSphere& sphere, glm::dvec3* normal);
  glm::dvec3 point_of(const reference::OpenCylinder& cylinder, glm::dvec3* normal);
  glm::dvec3 point_of(const reference::PartialDisk& disk, glm::dvec3* normal);
  glm::dvec3 point_of(const reference::Bilinear& patch, glm::dvec3* normal);
  glm::dvec3 point_of(const reference::MolecularPatch& patch, glm::dvec3* normal);
  glm::dvec3 point_of(const reference::Csg& csg, glm::dvec3* normal);
  double between(double low, double high) {
    return below(4) == 0 ? low : below(3) == 0 ? high : uniform(low, high);
  }
  std::mt19937 random_;
};

/// The place and size go into the operands, as they do in lower.
CsgShape placed_csg(CsgShape csg, const glm::dmat4& m);

/// Where a primitive lies and how large it is.
struct Extent {
  glm::dvec3 center;
  double radius;  // of the bounding ball
  double reach;   // L + r0 + r1, or the edge lengths: what kernel errors grow with
};
Extent extent_of(const FlatPrimitive& primitive, const reference::Primitive& reference);

/// Bound on the distance of o + t d from the surface, as the table of docs/numerics.md
/// ("Traversal") states it; what else stands there about csg shapes.
double surface_bound(const FlatPrimitive& primitive, const reference::Primitive& reference,
                     const RayRecord& ray);

/// The primitives placed by random affine maps (turned, stretched by 0.2 to 3 along each axis,
/// every other one mirrored, moved), the rays with them.
struct PlacedCases {
  CaseSet cases;  // rays in the world
  std::vector<PlacedPrimitive> placed;
  std::vector<glm::dmat4> world_from_object;  // as rounded to float
};
PlacedCases placed_cases(CaseSet cases, std::uint32_t seed);

}  // namespace caplet::test
