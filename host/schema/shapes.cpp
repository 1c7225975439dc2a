// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Schema of shapes, whose readers (import/shapes) make lists of primitives.
#include <array>
#include <string>

#include "schema/detail/describe.h"
#include "schema/detail/rows.h"

namespace caplet::schema {

namespace {

constexpr Row positions = {{"P", "points"}, "point3"};
constexpr Row normals = {{"N", "normals at the points"}, "normal"};
constexpr Row uvs = {{"uv", "texture coordinates at the points"}, "point2"};
constexpr Row mesh_times = {
    {"times", "when the points are as the list says, all at each; none: they rest", -no_limit,
     no_limit, "seconds"},
    "float"};
constexpr Row st = {{"st", "the same as uv"}, "point2"};
constexpr Row first_end = {{"p0", "an end of the axis"}, "point3"};
constexpr Row second_end = {{"p1", "the other end"}, "point3"};
constexpr Row caps = {
    {"caps", "\"flat\", \"round\" or \"open\"; one, or one an end"}, "string", "flat"};
constexpr Row phi_max = {
    {"phimax", "how far it goes around the z axis", 0, 360, "degrees", true}, "float", "360"};

constexpr std::array all_rows = {
    Row{{"name", "what it is called"}, "string"},
    Row{{"materials", "names of materials, one a surface in order"}, "string"},
    Row{{"onesided", "seen from outside alone"}, "bool", "false"},
    Row{{"alpha", "probability that it stops a ray"}, "float texture", "1"}};

constexpr std::array bilinear_rows = {
    positions, Row{{"indices", "corners, in fours: p00 p10 p01 p11"}, "integer"}, normals, uvs};
constexpr std::array bilinear_ignored = {
    Row{{"faceIndices", "of Ptex"}, "integer"},
    Row{{"emissionfilename", "of samples of lights"}, "string"}};
constexpr std::array capsule_rows = {first_end, second_end,
                                     Row{{"radius", "one, or one an end", 0}, "float"},
                                     Row{{"u", "u at the two ends; none: 0 and 1"}, "float"}};
constexpr std::array capsules_rows = {
    Row{{"filename", "a .capsules file, in place of the lists"}, "string"},
    Row{{"p0", "first ends, one a capsule"}, "point3"},
    Row{{"p1", "second ends"}, "point3"},
    Row{{"radius", "radii, at the first ends where radius1 is given", 0}, "float"},
    Row{{"radius1", "radii at the second ends", 0}, "float"},
    Row{{"u", "u at the ends, two a capsule"}, "float"},
    Row{{"times", "when they are as the lists say, all at each; none: they rest", -no_limit,
         no_limit, "seconds"},
        "float"},
    Row{{"capsulematerials", "names of materials; \"\" is the shape's own"}, "string"},
    Row{{"materialindices", "which of capsulematerials each capsule has", 0}, "integer"}};
constexpr std::array cone_rows = {
    first_end, second_end, Row{{"radius", "one an end; with one value p1 is the apex", 0}, "float"},
    caps};
constexpr std::array csg_rows = {
    Row{{"operation", "\"union\", \"intersection\" or \"difference\""}, "string", "union"},
    Row{{"operands", "names of objects, at least two"}, "string"}};
constexpr std::array curve_rows = {
    positions,
    Row{{"basis", "\"bezier\" or \"bspline\""}, "string", "bezier"},
    Row{{"degree", "degree of the pieces", 2, 3}, "integer", "3"},
    Row{{"width", "diameter", 0}, "float", "1"},
    Row{{"width0", "diameter where it begins", 0}, "float", "that of width"},
    Row{{"width1", "diameter where it ends", 0}, "float", "that of width"},
    Row{{"type", "\"flat\", \"cylinder\" or \"ribbon\": all are round tubes"}, "string", "flat"},
    Row{{"N", "normals of a ribbon"}, "normal"},
    Row{{"urange", "what u runs along from 0 to 1: each \"piece\", or the \"curve\""},
        "string",
        "piece"}};
constexpr std::array curve_ignored = {Row{{"splitdepth", "of pbrt-v4's curves"}, "integer float"}};
constexpr std::array cylinder_rows = {
    first_end,
    second_end,
    Row{{"radius", "radius", 0, no_limit, "", true}, "float", "1 without p0 and p1"},
    caps,
    Row{{"zmin", "lower end, without p0 and p1"}, "float", "-1"},
    Row{{"zmax", "upper end, without p0 and p1"}, "float", "1"},
    phi_max};
constexpr std::array disk_rows = {Row{{"radius", "radius", 0, no_limit, "", true}, "float", "1"},
                                  Row{{"height", "place along z"}, "float", "0"},
                                  Row{{"innerradius", "radius of the hole", 0}, "float", "0"},
                                  phi_max};
constexpr std::array file_rows = {
    Row{{"filename", "a file of another format; its options are parameters too"}, "string"},
    Row{{"name", "prefix of its shapes' names"}, "string"},
    Row{{"onesided", "its shapes are seen from outside alone"}, "bool", "false"},
    Row{{"ownmaterials", "its shapes keep the file's materials"}, "bool", "false"}};
constexpr std::array loop_rows = {
    positions, Row{{"indices", "corners, in threes"}, "integer"},
    Row{{"levels", "times that each triangle becomes four", 0, 12}, "integer", "3"}};
constexpr std::array loop_ignored = {Row{{"scheme", "Loop's always"}, "string"}};
constexpr std::array molecule_rows = {
    Row{{"P", "centres of the balls"}, "point3"},
    Row{{"radius", "the balls' radii: one, or one a ball", 0, no_limit, "", true}, "float"},
    Row{{"probe", "radius of the probe", 0, no_limit, "", true}, "float", "1.4"},
    Row{{"ballmaterials", "names of materials; \"\" is the shape's own"}, "string"},
    Row{{"materialindices", "which of ballmaterials each ball has", 0}, "integer"}};
constexpr std::array ply_rows = {
    Row{{"filename", "a PLY file; of a mesh that moves one a time"}, "string"}, mesh_times};
constexpr std::array polyhedron_rows = {Row{{"P", "a point of each plane, at most 1024"}, "point3"},
                                        Row{{"N", "the planes' outward normals"}, "normal"}};
constexpr std::array sphere_rows = {Row{{"radius", "radius", 0, no_limit, "", true}, "float", "1"},
                                    Row{{"zmin", "lower end"}, "float", "-radius"},
                                    Row{{"zmax", "upper end"}, "float", "radius"}, phi_max};
constexpr std::array triangle_rows = {
    positions, Row{{"indices", "corners, in threes"}, "integer"}, normals, uvs, st, mesh_times};
constexpr std::array triangle_ignored = {Row{{"S", "tangents"}, "vector3"},
                                         Row{{"faceIndices", "of Ptex"}, "integer"}};

/// Collects the parameters of a geometry that names its fields.
struct Each : Fields {
  explicit Each(std::vector<Parameter>& out) : to(out) {}
  void corners(const char* name0, const char* name1, glm::dvec3&, glm::dvec3&) override {
    to.position({name0, "a corner"}, glm::dvec3(0));
    to.position({name1, "the opposite corner"}, glm::dvec3(0));
  }
  void positive(const char* name, double&) override {
    to.add({name, "a length", 0, no_limit, "", true}, {"float"}, "");
  }
  Describe to;
};

template <class Type>
void add_fields(std::vector<Parameter>& out) {
  if constexpr (FieldedShape<Type>) {
    Type geometry;
    Each each(out);
    fields(geometry, each);
  }
}

}  // namespace

void add_shape(const std::string& type, std::vector<Parameter>& out) {
  if (type == "bilinearmesh") add_rows(bilinear_rows, out), add_ignored(bilinear_ignored, out);
  if (type == "capsule") add_rows(capsule_rows, out);
  if (type == "capsules") add_rows(capsules_rows, out);
  if (type == "cone") add_rows(cone_rows, out);
  if (type == "csg") add_rows(csg_rows, out);
  if (type == "curve") add_rows(curve_rows, out), add_ignored(curve_ignored, out);
  if (type == "cylinder") add_rows(cylinder_rows, out);
  if (type == "disk") add_rows(disk_rows, out);
  if (type == "loopsubdiv") add_rows(loop_rows, out), add_ignored(loop_ignored, out);
  if (type == "molecularsurface") add_rows(molecule_rows, out);
  if (type == "plymesh") add_rows(ply_rows, out);
  if (type == "polyhedron") add_rows(polyhedron_rows, out);
  if (type == "sphere") add_rows(sphere_rows, out);
  if (type == "trianglemesh") add_rows(triangle_rows, out), add_ignored(triangle_ignored, out);
#define GEOMETRY(Type, row) \
  if (type == #row) add_fields<Type>(out);
#include "scene/geometries.def"
  if (type == "file" || type == "swc") return add_rows(file_rows, out);
  if (!out.empty()) add_rows(all_rows, out);
}

}  // namespace caplet::schema
