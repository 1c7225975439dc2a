// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Shapes from files of other formats: Shape "file" and Shape "swc" (docs/formats/pbrt.md).
#include <algorithm>
#include <map>
#include <utility>

#include "base/reading.h"
#include "import/detail/pbrt_parser.h"
#include "scene/append.h"

namespace caplet::pbrt {

namespace {

const Format& format_named(const std::string& name) { return *std::ranges::find(formats(), name, &Format::name); }

/// Removes the file's materials, so that the statement's material is used.
void take_off_materials(Scene& scene) {
  scene.materials.clear();
  scene.textures.clear();
  const auto visit = [](Shape& shape) {
    shape.material = 0;
    shape.materials.clear();
    if (auto* capsules = std::get_if<CapsulesShape>(&shape.geometry)) capsules->materials.clear();
    shape.alpha.reset();
    shape.emission.reset();
  };
  std::ranges::for_each(scene.shapes, visit);
  for (Object& object : scene.objects) std::ranges::for_each(object.shapes, visit);
}

/// Returns the value of an option in a statement. Files that it names lie where the scene's other files do.
std::string value_of(Parameters& given, const std::string& option) {
  std::string value = given.text(option, "");
  if (option != "color" && option != "positions" && option != "components") return value;
  std::string file = resolve_file(value, given.where(option), given.main_file());
  return option != "color" || is_there(file, given.where(option)) ? file : value;  // most colours are keywords
}

}  // namespace

void Parser::put_as_stated(Shape& shape, const SourceLocation& where, bool is_instanced) const {
  if (!is_instanced) shape.world_from_object = state_.ctm * shape.world_from_object;
  shape.where = where;
  shape.reverse_orientation = shape.reverse_orientation != state_.reverse_orientation;
  if (state_.emission) shape.emission = state_.emission;
  shape.media = state_.media;
}

void Parser::shapes_of_file(const std::string& type, Parameters& given) {
  if (!given.has("filename")) given.error("\"string filename\" is missing");
  const std::string name = given.text("filename", ""), prefix = given.text("name", "");
  const std::string path = name.empty() ? name : resolve_file(name, given.where("filename"), given.main_file());
  const bool one_sided = given.boolean("onesided", false), says_sides = given.has("onesided");
  std::optional<Imported> file;
  bool own_materials = false;
  if (!path.empty()) try {
      const Format* format = type == "file" ? &format_of(path) : &format_named(type);
      if (format->name == "pbrt-v4") throw InputError("a pbrt scene is read by Include or Import");
      ImportOptions options;
      options.are_of_scene = true;
      for (const std::string& option : format->options)
        if (given.has(option)) options.set(option, value_of(given, option));
      own_materials = given.boolean("ownmaterials", options.text("color").has_value());
      file = read_scene(path, images_, options, format);
    } catch (const InputError& problem) {
      add_errors(problem, given.where("filename"), diagnostics_);
    }
  if (path.empty() || file) given.finish();
  if (!file) return;
  Scene& part = file->scene;
  if (object_ && !part.instances.empty())
    return diagnostics_.error(where_,
                              path + " holds instances, which cannot be within ObjectBegin: the statement belongs outside");
  if (file->has_camera || !part.lights.empty())
    diagnostics_.warning(where_, "the shapes alone of " + path + " are taken: not its camera and lights");
  part.lights.clear();
  if (!own_materials) take_off_materials(part);
  const std::size_t first_shape = scene_.shapes.size(), first_instance = scene_.instances.size();
  if (!prefix.empty()) prefix_names(part, prefix);
  const Appended added = append(scene_, std::move(part));
  std::map<std::uint32_t, std::uint32_t> uses;
  const auto visit = [&](Shape& shape, bool is_instanced) {
    each_material(shape, [&](std::uint32_t& material) {
      if (!own_materials) {
        material = state_.material;
        return;
      }
      const auto [at, fresh] = uses.emplace(material, static_cast<std::uint32_t>(uses_.size()));
      if (fresh) uses_.push_back({std::nullopt, "", where_, material});
      material = at->second;
    });
    put_as_stated(shape, where_, is_instanced);
    shape.one_sided = shape.one_sided || one_sided;
  };
  for (std::size_t i = first_shape; i < scene_.shapes.size(); ++i) visit(scene_.shapes[i], false);
  for (std::size_t i = added.objects; i < scene_.objects.size(); ++i)
    for (Shape& shape : scene_.objects[i].shapes) visit(shape, true);
  for (std::size_t i = first_instance; i < scene_.instances.size(); ++i) {
    scene_.instances[i].world_from_object = state_.ctm * scene_.instances[i].world_from_object;
    scene_.instances[i].where = where_;
  }
  if (says_sides && !one_sided) said_two_sided_.insert(where_.to_string());
  if (!object_) return;
  const auto begin = scene_.shapes.begin() + static_cast<std::ptrdiff_t>(first_shape);
  std::vector<Shape>& into = scene_.objects[*object_].shapes;
  std::move(begin, scene_.shapes.end(), std::back_inserter(into));
  scene_.shapes.erase(begin, scene_.shapes.end());
}

}  // namespace caplet::pbrt
