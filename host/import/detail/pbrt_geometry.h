// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The geometry behind Shape statements, one reader a type (docs/formats/pbrt.md). What is wrong is reported with its place, and
// something harmless is returned: the scene is then refused as a whole.
#pragma once

#include <glm/vec3.hpp>
#include <string_view>
#include <variant>

#include "import/detail/capsules.h"
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
/// "float NAME": one value, positive and at most largest_length.
double positive_length(Parameters& parameters, std::string_view name, double fallback);
/// "float radius": one value, positive and at most largest_length.
double positive_radius(Parameters& parameters, double fallback);
/// "phimax" in radians, above 0 and at most a full turn (more is a full turn, as in pbrt).
double phi_max(Parameters& parameters);
/// A length of either sign, at most largest_length.
double length(Parameters& parameters, std::string_view name, double fallback);

/// Asks a statement for the fields of a shape: corners must be given.
class ReadFields : public Fields {
 public:
  explicit ReadFields(Parameters& parameters);
  void corners(const char* name0, const char* name1, glm::dvec3& p0, glm::dvec3& p1) override;
  void positive(const char* name, double& value) override;
  /// Whether nothing is missing.
  bool complete() const { return complete_; }

 private:
  Parameters& parameters_;
  bool complete_ = true;
};

/// What is wrong with a shape, at its statement or at the parameter of the field's name.
class FieldCheck : public ShapeCheck {
 public:
  explicit FieldCheck(Parameters& parameters);
  void error(const std::string& message) override;
  void error(std::string_view field, const std::string& message) override;
  std::size_t materials() const override { return 0; }
  void operand(const Shape&) override {}
  bool good() const { return good_; }

 private:
  Parameters& parameters_;
  bool good_ = true;
};

/// A shape whose model names its fields. Where something is missing or wrong, which is reported, as it is by default.
template <FieldedShape Type>
Type read_fields(Parameters& parameters) {
  Type shape;
  ReadFields each(parameters);
  fields(shape, each);
  if (!each.complete()) return {};
  FieldCheck report(parameters);
  check(shape, report);
  return report.good() ? shape : Type{};
}

/// Whole, or pbrt's part of one.
Geometry make_sphere(Parameters& parameters);
DiskShape make_disk(Parameters& parameters);
CapsulesShape make_capsule(Parameters& parameters);
/// "float u": two a capsule, at p0 and at p1; none where it is not there or wrong (reported).
std::vector<glm::vec2> chain_u(Parameters& parameters, std::size_t capsules);
/// The capsules of a statement's own lists.
CapsulesShape make_capsule_list(Parameters& parameters, const MaterialIndex& material_index);
/// With "p0" or "p1" ours, otherwise pbrt's open one.
Geometry make_cylinder(Parameters& parameters);
ConeShape make_cone(Parameters& parameters);
PolyhedronShape make_polyhedron(Parameters& parameters);
TriangleMeshShape make_triangle_mesh(Parameters& parameters);
/// Its "P" and "indices" alone.
TriangleMeshShape make_vertices_and_triangles(Parameters& parameters);
/// "loopsubdiv": the limit of Loop's rules, as triangles of its level (shapes/loop_subdivision.cpp).
TriangleMeshShape make_loop_subdivision(Parameters& parameters);
BilinearMeshShape make_bilinear_mesh(Parameters& parameters);
/// Chains of tapered capsules along pbrt's curve: no point of a chain's axis is further from the curve's point of the same
/// parameter than max(1e-3 of the greater width, 1e-5 of the diagonal of the control points' bounds). As radii run linearly in
/// the same parameter, that is also the Hausdorff distance of the chain from the round tube.
CapsulesShape make_curve(Parameters& parameters);
CsgShape make_csg(Parameters& parameters, const ObjectLookup& objects);

}  // namespace caplet::pbrt
