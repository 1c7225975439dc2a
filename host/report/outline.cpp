// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "report/outline.h"

#include <map>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "base/utf8.h"

namespace caplet::report {

namespace {

/// Numbers the files that shapes came from.
class ShapeFiles {
 public:
  std::size_t number(const std::string& file) {
    const auto [at, is_new] = numbers_.emplace(file, names_.size());
    if (is_new) names_.push_back(file);
    return at->second;
  }
  const std::vector<std::string>& names() const { return names_; }

 private:
  std::map<std::string, std::size_t> numbers_;
  std::vector<std::string> names_;
};

nlohmann::json names_of_shapes(const std::vector<Shape>& shapes, ShapeFiles& files) {
  nlohmann::json out = nlohmann::json::array();
  for (const Shape& shape : shapes)
    out.push_back({shape.name, geometry_name(shape), files.number(shape.where.file)});
  return out;
}

[[noreturn]] void refuse_outline(const std::string& file, const std::string& why) {
  throw InputError({file}, "has a wrong outline of its scene: " + why);
}

/// Returns an empty geometry of that name (geometry_name).
Geometry empty_geometry(const std::string& name, const std::string& file) {
#define GEOMETRY(Type, own_name) \
  if (name == #own_name) return Type{};
#include "scene/geometries.def"
  refuse_outline(file, "no shapes are called '" + name + "'");
}

std::vector<Shape> named_shapes(const nlohmann::json& from, const nlohmann::json& files,
                                const std::string& file) {
  std::vector<Shape> out;
  out.reserve(from.size());
  for (const nlohmann::json& one : from) {
    Shape& shape = out.emplace_back();
    shape.name = one.at(0);
    shape.geometry = empty_geometry(one.at(1), file);
    shape.where.file = files.at(one.at(2).get<std::size_t>());
  }
  return out;
}

}  // namespace

std::string outline_text(const Scene& scene) {
  ShapeFiles files;
  nlohmann::json out;
  out["source"] = scene.source;
  out["materials"] = nlohmann::json::array();
  for (const Material& material : scene.materials) out["materials"].push_back(material.name);
  out["shapes"] = names_of_shapes(scene.shapes, files);
  out["objects"] = nlohmann::json::array();
  for (const Object& object : scene.objects)
    out["objects"].push_back({object.name, names_of_shapes(object.shapes, files)});
  out["instances"] = nlohmann::json::array();
  for (const Instance& instance : scene.instances) out["instances"].push_back(instance.object);
  out["files"] = files.names();
  return json_dump(out);
}

void add_outline(const std::string& text, const std::string& file, Scene& scene) {
  try {
    const nlohmann::json from = nlohmann::json::parse(text);
    const nlohmann::json& files = from.at("files");
    scene.source = from.at("source");
    for (const nlohmann::json& name : from.at("materials"))
      scene.materials.push_back({DiffuseMaterial{}, name, {}});
    scene.shapes = named_shapes(from.at("shapes"), files, file);
    for (const nlohmann::json& object : from.at("objects"))
      scene.objects.push_back({object.at(0), named_shapes(object.at(1), files, file), {}});
    for (const nlohmann::json& object : from.at("instances")) {
      scene.instances.emplace_back().object = object;
      if (scene.instances.back().object >= scene.objects.size())
        refuse_outline(file, "an instance is of no object");
    }
  } catch (const nlohmann::json::exception& error) {
    refuse_outline(file, error.what());
  }
}

}  // namespace caplet::report
