// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Readers of the geometry in Shape statements, one per type (docs/formats/pbrt.md). They report
// errors at their places and return something harmless, because the scene is then refused as a
// whole.
#pragma once

#include <glm/vec3.hpp>
#include <string_view>
#include <variant>

#include "import/detail/capsules.h"
#include "import/detail/pbrt/parameters.h"
#include "scene/scene.h"

namespace caplet::pbrt {

using Geometry = decltype(Shape::geometry);

/// Converts a number to float, and reports one that is too large.
float to_float(Parameters& parameters, std::string_view name, double value);
/// Returns all points or vectors of a parameter; none when it is missing.
std::vector<glm::vec3> vectors3(Parameters& parameters, const Parameter* values);
/// Returns one mandatory point, each coordinate at most largest_length.
glm::dvec3 required_point(Parameters& parameters, std::string_view name);
/// Reads "float NAME": one value, positive and at most largest_length.
double positive_length(Parameters& parameters, std::string_view name, double fallback);
/// Reads "float radius": one value, positive and at most largest_length.
double positive_radius(Parameters& parameters, double fallback);
/// Reads "phimax" in radians, above 0 and at most a full turn (larger values become a full turn, as
/// in pbrt).
double phi_max(Parameters& parameters);
/// Reads a length of either sign, at most largest_length.
double length(Parameters& parameters, std::string_view name, double fallback);

/// Reads the fields of a shape from a statement. Corners are mandatory.
class ReadFields : public Fields {
 public:
  explicit ReadFields(Parameters& parameters);
  void corners(const char* name0, const char* name1, glm::dvec3& p0, glm::dvec3& p1) override;
  void positive(const char* name, double& value) override;
  /// Returns whether all mandatory fields are present.
  bool complete() const { return complete_; }

 private:
  Parameters& parameters_;
  bool complete_ = true;
};

/// Reports errors of a shape at its statement, or at the parameter of the field's name.
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

/// Reads a shape whose model names its fields. If something is missing or wrong, it reports that
/// and returns the default shape.
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

/// Makes a whole sphere or pbrt's partial one.
Geometry make_sphere(Parameters& parameters);
DiskShape make_disk(Parameters& parameters);
CapsulesShape make_capsule(Parameters& parameters);
/// Reads "float times", two or more that rise; none where it is missing or wrong (reported).
std::vector<double> key_times(Parameters& parameters);
/// Reads "float u": two per capsule, at p0 and at p1; none where it is missing or wrong (reported).
std::vector<glm::vec2> chain_u(Parameters& parameters, std::size_t capsules);
/// Makes the capsules of the lists in a statement.
CapsulesShape make_capsule_list(Parameters& parameters, const MaterialIndex& material_index);
/// Reads the materials that "materialindices" selects from those that the parameter `list` names,
/// one for each of `count` things; none where they are missing or wrong (reported).
std::vector<std::uint32_t> listed_materials(Parameters& parameters, const char* list,
                                            const MaterialIndex& material_index, std::size_t count,
                                            const char* things);
MolecularSurfaceShape make_molecular_surface(Parameters& parameters,
                                             const MaterialIndex& material_index);
/// Makes our cylinder if "p0" or "p1" is given, otherwise pbrt's open one.
Geometry make_cylinder(Parameters& parameters);
ConeShape make_cone(Parameters& parameters);
PolyhedronShape make_polyhedron(Parameters& parameters);
TriangleMeshShape make_triangle_mesh(Parameters& parameters);
/// Reads only "P" and "indices".
TriangleMeshShape make_vertices_and_triangles(Parameters& parameters);
/// Makes a "loopsubdiv": the limit surface of Loop's rules, as triangles of its level
/// (shapes/loop_subdivision.cpp).
TriangleMeshShape make_loop_subdivision(Parameters& parameters);
BilinearMeshShape make_bilinear_mesh(Parameters& parameters);
/// Makes chains of tapered capsules along pbrt's curve. The distance between a chain's axis and the
/// curve at the same parameter is at most max(1e-3 of the greater width, 1e-5 of the diagonal of
/// the control points' bounds). Radii are linear in the same parameter, so this also bounds the
/// Hausdorff distance of the chain from the round tube.
CapsulesShape make_curve(Parameters& parameters);
CsgShape make_csg(Parameters& parameters, const ObjectLookup& objects);

}  // namespace caplet::pbrt
