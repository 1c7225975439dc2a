// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "import/pbrt_shapes.h"

#include <cmath>
#include <limits>

#include "base/log.h"
#include "import/capsules.h"
#include "import/ply.h"

namespace caplet::pbrt {

namespace {

/// A length as a float; reports when it is none.
float to_float(Parameters& parameters, std::string_view name, double value) {
  if (std::abs(value) <= std::numeric_limits<float>::max()) return static_cast<float>(value);
  parameters.error(name, "is too large a number");
  return 0;
}

std::vector<glm::vec3> vectors3(Parameters& parameters, const Parameter* values) {
  std::vector<glm::vec3> out;
  if (!values) return out;
  const auto& n = values->numbers;
  out.reserve(n.size() / 3);
  for (std::size_t i = 0; i + 2 < n.size(); i += 3)
    out.emplace_back(to_float(parameters, values->name, n[i]), to_float(parameters, values->name, n[i + 1]),
                     to_float(parameters, values->name, n[i + 2]));
  return out;
}

double positive_radius(Parameters& parameters, double fallback) {
  const double radius = parameters.number("radius", fallback);
  if (radius > 0) return radius;
  parameters.error("radius", "must be positive");
  return fallback;
}

/// Parts of a sphere or disk are known to pbrt and not rendered yet.
void refuse_unless(Parameters& parameters, const char* name, double whole, bool (*covers)(double given, double whole)) {
  if (!covers(parameters.number(name, whole), whole)) parameters.error(name, "makes a partial shape, which is not rendered yet");
}

SphereShape make_sphere(Parameters& parameters) {
  const SphereShape sphere{positive_radius(parameters, 1)};
  refuse_unless(parameters, "zmin", -sphere.radius, [](double given, double whole) { return given <= whole; });
  refuse_unless(parameters, "zmax", sphere.radius, [](double given, double whole) { return given >= whole; });
  refuse_unless(parameters, "phimax", 360, [](double given, double whole) { return given >= whole; });
  return sphere;
}

DiskShape make_disk(Parameters& parameters) {
  const DiskShape disk{parameters.number("height", 0), positive_radius(parameters, 1)};
  refuse_unless(parameters, "innerradius", 0, [](double given, double whole) { return given == whole; });
  refuse_unless(parameters, "phimax", 360, [](double given, double whole) { return given >= whole; });
  return disk;
}

CapsulesShape make_capsule(Parameters& parameters) {
  CapsulesShape capsule;
  for (const char* name : {"p0", "p1"}) {
    if (!parameters.has(name)) parameters.error("\"point3 " + std::string(name) + "\" is missing");
    const glm::dvec3 p = parameters.point(name, glm::dvec3(0));
    (name[1] == '0' ? capsule.p0 : capsule.p1)
        .emplace_back(to_float(parameters, name, p.x), to_float(parameters, name, p.y), to_float(parameters, name, p.z));
  }
  if (!parameters.has("radius")) parameters.error("\"float radius\" is missing");
  const Parameter* radius = parameters.values("radius", {"float"});
  if (!radius) return capsule;
  const auto& r = radius->numbers;
  if (r.size() > 2)
    parameters.error("radius", "takes 1 or 2 values, not " + std::to_string(r.size()));
  else if (*std::min_element(r.begin(), r.end()) < 0 || *std::max_element(r.begin(), r.end()) <= 0)
    parameters.error("radius", "must be positive (of two radii one may be 0)");
  capsule.radius0 = {to_float(parameters, "radius", r[0])};
  if (r.size() == 2 && r[1] != r[0]) capsule.radius1 = {to_float(parameters, "radius", r[1])};
  return capsule;
}

TriangleMeshShape make_mesh(Parameters& parameters) {
  TriangleMeshShape mesh;
  if (!parameters.has("P")) parameters.error("\"point3 P\" is missing");
  mesh.positions = vectors3(parameters, parameters.values("P", {"point3"}));
  const std::size_t count = mesh.positions.size();
  mesh.normals = vectors3(parameters, parameters.values("N", {"normal"}));
  const auto one_a_vertex = [&](const char* name, std::size_t given) {
    if (given != 0 && count != 0 && given != count)
      parameters.error(name, "has " + std::to_string(given) + " entries for " + std::to_string(count) + " vertices");
  };
  one_a_vertex("N", mesh.normals.size());
  if (parameters.has("uv") && parameters.has("st")) parameters.error("st", "cannot be combined with \"uv\"");
  for (const char* name : {"uv", "st"})
    if (const Parameter* uv = parameters.values(name, {"point2"})) {
      for (std::size_t i = 0; i + 1 < uv->numbers.size(); i += 2)
        mesh.uvs.emplace_back(to_float(parameters, name, uv->numbers[i]), to_float(parameters, name, uv->numbers[i + 1]));
      one_a_vertex(name, mesh.uvs.size());
    }
  if (parameters.values("S", {"vector3"}))
    log::info("{}: \"S\" (tangents) has no effect and is ignored", parameters.where("S").to_string());
  parameters.values("faceIndices", {"integer"});
  const Parameter* indices = parameters.values("indices", {"integer"});
  if (!indices) {
    if (parameters.has("indices") || count == 0) return mesh;
    if (count == 3)
      mesh.triangles.push_back({0, 1, 2});
    else
      parameters.error("\"integer indices\" is missing (only a mesh of 3 vertices needs none)");
    return mesh;
  }
  const auto& n = indices->numbers;
  if (n.size() % 3) parameters.error("indices", "takes a multiple of 3 values, not " + std::to_string(n.size()));
  mesh.triangles.reserve(n.size() / 3);
  for (std::size_t i = 0; i + 2 < n.size(); i += 3) {
    for (std::size_t k = i; k < i + 3; ++k)
      if (count != 0 && (n[k] < 0 || n[k] >= static_cast<double>(count))) {
        parameters.error("indices", "has the index " + std::to_string(static_cast<int>(n[k])) + " (entry " + std::to_string(k) +
                                        "), but there are " + std::to_string(count) + " vertices");
        return mesh;
      }
    mesh.triangles.push_back(
        {static_cast<std::uint32_t>(n[i]), static_cast<std::uint32_t>(n[i + 1]), static_cast<std::uint32_t>(n[i + 2])});
  }
  return mesh;
}

/// The file behind "string filename"; empty when missing (reported).
std::string file_of(Parameters& parameters) {
  if (!parameters.has("filename")) parameters.error("\"string filename\" is missing");
  const std::string name = parameters.text("filename", "");
  return name.empty() ? name : resolve_file(name, parameters.where("filename"), parameters.main_file());
}

/// Runs a reader of another file; its errors are reported beside ours.
template <class Read>
auto read_other(Parameters& parameters, Read read) -> decltype(read()) {
  try {
    return read();
  } catch (const InputError& problem) {
    for (const std::string& message : problem.messages()) parameters.diagnostics().error({}, message);
    return {};
  }
}

}  // namespace

std::optional<Shape> make_shape(const std::string& type, Parameters& parameters, std::uint32_t material,
                                const TextureTable& textures, const MaterialIndex& material_index) {
  Shape shape;
  shape.where = parameters.where();
  shape.material = material;
  shape.name = parameters.text("name", "");
  if (const Parameter* materials = parameters.values("materials", {"string"})) {
    if (materials->strings.size() == 1)
      shape.material = material_index(materials->strings[0], materials->where);
    else
      parameters.error("materials", "takes 1 name (the shape has one surface), not " + std::to_string(materials->strings.size()));
  }
  if (parameters.boolean("onesided", false)) parameters.refuse("onesided");
  if (parameters.number_or_texture("alpha", 1, textures) != 1) parameters.error("alpha", "other than 1 is not rendered yet");
  const auto index_or_default = [&](const std::string& name, const SourceLocation& where) {
    return name.empty() ? shape.material : material_index(name, where);
  };
  if (type == "sphere") {
    shape.geometry = make_sphere(parameters);
  } else if (type == "disk") {
    shape.geometry = make_disk(parameters);
  } else if (type == "capsule") {
    shape.geometry = make_capsule(parameters);
  } else if (type == "trianglemesh") {
    shape.geometry = make_mesh(parameters);
  } else {
    if (type == "plymesh")
      for (const char* name : {"displacement", "displacement.edgelength", "displacement.uvscale"}) parameters.refuse(name);
    const std::string file = file_of(parameters);
    const SourceLocation where = parameters.where("filename");
    if (!file.empty() && type == "plymesh")
      shape.geometry = read_other(parameters, [&] { return read_ply(file, where); });
    else if (!file.empty())
      shape.geometry = read_other(parameters, [&] {
        std::error_code ignored;
        if (!std::filesystem::exists(file, ignored)) throw InputError(where, file + ": no such file");
        return read_capsules(file, index_or_default);
      });
  }
  parameters.finish();
  return shape;
}

}  // namespace caplet::pbrt
