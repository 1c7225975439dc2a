// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "import/detail/pbrt/shapes.h"

#include <filesystem>
#include <stdexcept>

#include "base/reading.h"
#include "import/detail/capsules.h"
#include "import/detail/pbrt/geometry.h"
#include "import/detail/ply.h"

namespace caplet::pbrt {

namespace {

/// Returns the file of "string filename"; empty when it is missing (reported).
std::string file_of(Parameters& parameters) {
  if (!parameters.has("filename")) parameters.error("\"string filename\" is missing");
  const std::string name = parameters.text("filename", "");
  return name.empty() ? name
                      : resolve_file(name, parameters.where("filename"), parameters.main_file());
}

/// Runs a reader of the file in "filename"; its errors are reported with ours.
template <class Read>
auto read_other(Parameters& parameters, Read read) -> decltype(read()) {
  try {
    return read();
  } catch (const InputError& problem) {
    add_errors(problem, parameters.where("filename"), parameters.diagnostics());
    return {};
  }
}

/// Reads a mesh whose vertices move: a file for each of its "times", with the same faces.
TriangleMeshShape make_moving_ply_mesh(Parameters& parameters) {
  const std::vector<double> times = key_times(parameters);
  const Parameter* files = parameters.values("filename", {"string"});
  if (!files || times.size() != files->strings.size()) {
    if (!times.empty() || !parameters.has("times"))
      parameters.error("filename", "takes one file a time of \"times\", not " +
                                       std::to_string(files ? files->strings.size() : 0) + " for " +
                                       std::to_string(times.size()));
    return {};
  }
  const SourceLocation where = parameters.where("filename");
  return read_other(parameters, [&] {
    TriangleMeshShape out;
    std::size_t count = 0;
    for (const std::string& name : files->strings) {
      const std::string file = resolve_file(name, where, parameters.main_file());
      TriangleMeshShape mesh = read_ply(file, where);
      if (out.positions.empty()) {
        count = mesh.positions.size();
        out = std::move(mesh);
        out.times = times;
        continue;
      }
      if (mesh.positions.size() != count || mesh.triangles != out.triangles ||
          mesh.normals.empty() != out.normals.empty())
        throw InputError(where, file + " has other vertices, faces or normals than " +
                                    files->strings.front() + ", so nothing says how it moves");
      out.positions.insert(out.positions.end(), mesh.positions.begin(), mesh.positions.end());
      out.normals.insert(out.normals.end(), mesh.normals.begin(), mesh.normals.end());
    }
    return out;
  });
}

Geometry make_ply_mesh(Parameters& parameters) {
  for (const char* name : {"displacement", "displacement.edgelength", "displacement.uvscale"})
    if (parameters.has(name))
      parameters.error(name, "is not rendered yet", "not rendered: " + std::string(name));
  const Parameter* files = parameters.values("filename", {"string"});
  if (parameters.has("times") || (files && files->strings.size() > 1))
    return make_moving_ply_mesh(parameters);
  const std::string file = file_of(parameters);
  if (file.empty()) return TriangleMeshShape{};
  return read_other(parameters, [&] { return read_ply(file, parameters.where("filename")); });
}

Geometry make_capsules(Parameters& parameters, const MaterialIndex& material_index) {
  if (parameters.has("p0")) return make_capsule_list(parameters, material_index);
  const std::string file = file_of(parameters);
  if (file.empty()) return CapsulesShape{};
  return read_other(parameters, [&] {
    if (!is_there(file, parameters.where("filename")))
      throw InputError(parameters.where("filename"), file + ": no such file");
    return read_capsules(file, material_index);
  });
}

template <class Type>
std::optional<Geometry> made_by_fields(const char* name, const std::string& type,
                                       Parameters& parameters) {
  if constexpr (FieldedShape<Type>)
    if (type == name) return read_fields<Type>(parameters);
  return {};
}

Geometry make_geometry(const std::string& type, Parameters& parameters,
                       const MaterialIndex& material_or_default, const ShapeContext& context) {
#define SHAPE_TYPE(name, make) \
  if (type == #name) return make;
#include "import/pbrt/shape_types.def"
#undef SHAPE_TYPE
#define GEOMETRY(Type, name) \
  if (auto made = made_by_fields<Type>(#name, type, parameters)) return *std::move(made);
#include "scene/geometries.def"
  throw std::logic_error("names.cpp knows a type of shape that the list does not");
}

/// Reads "string materials": one name per surface.
void set_materials(Parameters& parameters, const MaterialIndex& material_index, Shape& shape) {
  const Parameter* names = parameters.values("materials", {"string"});
  const std::size_t surfaces = surface_count(shape);
  if (!names || surfaces == 0) return;  // without surfaces the geometry was wrong, and is reported
  if (names->strings.size() != surfaces) {
    parameters.error("materials",
                     "takes " + std::to_string(surfaces) + (surfaces == 1 ? " name" : " names") +
                         ", one a surface, not " + std::to_string(names->strings.size()));
    return;
  }
  for (const std::string& name : names->strings)
    shape.materials.push_back(material_index(name, names->where));
  shape.material = shape.materials[0];
  if (surfaces == 1) shape.materials.clear();
}

}  // namespace

Shape make_shape(const std::string& type, Parameters& parameters, std::uint32_t material,
                 const ShapeContext& context) {
  Shape shape;
  shape.where = parameters.where();
  shape.material = material;
  shape.name = parameters.text("name", "");
  shape.one_sided = parameters.boolean("onesided", false);
  TextureOperand alpha = 1;
  if (alpha.texture = parameters.texture("alpha", true, context.textures); !alpha.texture)
    alpha = parameters.number_or_texture("alpha", 1, context.textures);
  if (alpha.texture || std::get<ConstantSpectrum>(alpha.value).value < 1) shape.alpha = alpha;
  // Surfaces come first, because parts without their own material use the shape's.
  const bool has_parts = type == "capsules" || type == "molecularsurface";
  if (has_parts) set_materials(parameters, context.material_index, shape);
  const auto material_or_default = [&](const std::string& name, const SourceLocation& where) {
    return name.empty() ? shape.material : context.material_index(name, where);
  };
  shape.geometry = make_geometry(type, parameters, material_or_default, context);
  if (const auto* csg = std::get_if<CsgShape>(&shape.geometry); csg && !csg->operands.empty())
    shape.material = csg->operands[0]->material;  // no surface has the statement's own material
  if (!has_parts) set_materials(parameters, context.material_index, shape);
  parameters.finish();
  return shape;
}

}  // namespace caplet::pbrt
