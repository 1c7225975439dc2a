// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Shapes from files of other formats: Shape "file" and Shape "swc" (docs/formats/pbrt.md).
#include <algorithm>
#include <map>
#include <utility>

#include "base/reading.h"
#include "import/detail/pbrt/builder.h"
#include "import/detail/pbrt/resolve.h"
#include "scene/append.h"
#include "scene/part_materials.h"
#include "scene/transform.h"

namespace caplet::pbrt {

namespace {

const Format& format_named(const std::string& name) {
  return *std::ranges::find(formats(), name, &Format::name);
}

/// Removes the file's materials, so that the statement's material is used.
void take_off_materials(Scene& scene) {
  scene.materials.clear();
  scene.textures.clear();
  const auto visit = [](Shape& shape) {
    shape.material = 0;
    shape.materials.clear();
    if (auto* parts = part_materials(shape)) parts->clear();
    shape.alpha.reset();
    shape.emission.reset();
  };
  std::ranges::for_each(scene.shapes, visit);
  for (Object& object : scene.objects) std::ranges::for_each(object.shapes, visit);
}

/// Returns the value of an option in a statement. Files that it names lie where the scene's other
/// files do.
std::string value_of(Parameters& given, const std::string& option) {
  std::string value = given.text(option, "");
  if (option != "color" && option != "positions" && option != "components") return value;
  std::string file = resolve_file(value, given.where(option), given.main_file());
  return option != "color" || is_there(file, given.where(option))
             ? file
             : value;  // most colours are keywords
}

/// Reads the file of the statement; no value where it cannot be read (reported). `own_materials`
/// receives whether the materials of the file count.
std::optional<Imported> read_file(const std::string& type, Parameters& given,
                                  const std::string& path, const ImageReader& images,
                                  bool& own_materials) try {
  const Format* format = type == "file" ? &format_of(path) : &format_named(type);
  if (format->name == "pbrt-v4") throw InputError("a pbrt scene is read by Include or Import");
  ImportOptions options;
  options.are_of_scene = true;
  for (const std::string& option : format->options)
    if (given.has(option)) options.set(option, value_of(given, option));
  own_materials = given.boolean("ownmaterials", options.text("color").has_value());
  return read_scene(path, images, options, format);
} catch (const InputError& problem) {
  add_errors(problem, given.where("filename"), given.diagnostics());
  return std::nullopt;
}

/// Gives shapes of a file the state at the statement.
class AsStated {
 public:
  AsStated(const Statement& at, Building& to, bool own_materials, bool one_sided)
      : at_(at), to_(to), own_materials_(own_materials), one_sided_(one_sided) {}

  void put(Shape& shape, bool is_instanced) {
    const GraphicsState& state = to_.state;
    each_material(shape, [&](std::uint32_t& material) { material = use_of(material); });
    if (!is_instanced && !state.transform.moves())
      shape.world_from_object = state.transform.start.matrix() * shape.world_from_object;
    shape.where = at_.where;
    shape.reverse_orientation = shape.reverse_orientation != state.reverse_orientation;
    if (state.emission) shape.emission = state.emission;
    shape.media = state.media;
    shape.one_sided = shape.one_sided || one_sided_;
  }
  void put(Instance& instance) {
    if (to_.state.transform.moves()) {
      if (!is_similarity(instance.world_from_object))
        to_.draft.diagnostics.error(at_.where, "moves an instance that the file stretches");
      instance.pivot = glm::dvec3(glm::inverse(instance.world_from_object)[3]);
      instance.motion = to_.keys();
      for (TransformKey& key : instance.motion) key.matrix *= instance.world_from_object;
    }
    instance.world_from_object = to_.state.transform.start.matrix() * instance.world_from_object;
    instance.where = at_.where;
  }

 private:
  /// Returns the use of a material that the file brought into the scene.
  std::uint32_t use_of(std::uint32_t material) {
    if (!own_materials_) return to_.state.material;
    std::vector<MaterialUse>& uses = to_.draft.materials.uses;
    const auto [found, fresh] = uses_.emplace(material, static_cast<std::uint32_t>(uses.size()));
    if (fresh) uses.push_back({std::nullopt, "", at_.where, material});
    return found->second;
  }

  const Statement& at_;
  Building& to_;
  bool own_materials_, one_sided_;
  std::map<std::uint32_t, std::uint32_t> uses_;  // by material of the scene
};

}  // namespace

void add_shapes_of_file(const Statement& at, const std::string& type, Parameters& given,
                        Building& to) {
  if (!given.has("filename")) given.error("\"string filename\" is missing");
  const std::string name = given.text("filename", ""), prefix = given.text("name", "");
  const std::string path =
      name.empty() ? name : resolve_file(name, given.where("filename"), given.main_file());
  const bool one_sided = given.boolean("onesided", false), says_sides = given.has("onesided");
  std::optional<Imported> file;
  bool own_materials = false;
  if (!path.empty()) file = read_file(type, given, path, to.draft.images, own_materials);
  if (path.empty() || file) given.finish();
  if (!file) return;
  Scene &part = file->scene, &scene = to.draft.scene;
  const auto& open = to.draft.objects.open;
  if (open && !part.instances.empty())
    return to.draft.diagnostics.error(
        at.where,
        path +
            " holds instances, which cannot be within ObjectBegin: the statement belongs outside");
  if (file->has_camera || !part.lights.empty())
    to.draft.diagnostics.warning(
        at.where, "the shapes alone of " + path + " are taken: not its camera and lights");
  part.lights.clear();
  if (!own_materials) take_off_materials(part);
  const std::size_t first_shape = scene.shapes.size(), first_instance = scene.instances.size();
  if (!prefix.empty()) prefix_names(part, prefix);
  const Appended added = append(scene, std::move(part));
  AsStated as_stated(at, to, own_materials, one_sided);
  for (std::size_t i = first_shape; i < scene.shapes.size(); ++i)
    as_stated.put(scene.shapes[i], false);
  for (std::size_t i = added.objects; i < scene.objects.size(); ++i)
    for (Shape& shape : scene.objects[i].shapes) as_stated.put(shape, true);
  for (std::size_t i = first_instance; i < scene.instances.size(); ++i)
    as_stated.put(scene.instances[i]);
  if (says_sides && !one_sided) to.draft.materials.said_two_sided.insert(at.where.to_string());
  if (to.state.transform.moves()) {
    const auto first = scene.shapes.begin() + static_cast<std::ptrdiff_t>(first_shape);
    std::vector<Shape> moving(std::make_move_iterator(first),
                              std::make_move_iterator(scene.shapes.end()));
    scene.shapes.erase(first, scene.shapes.end());
    for (Shape& shape : moving) to.draft.objects.add_moving(std::move(shape), to.keys(), scene);
    return;
  }
  if (!open) return;
  const auto begin = scene.shapes.begin() + static_cast<std::ptrdiff_t>(first_shape);
  std::move(begin, scene.shapes.end(), std::back_inserter(scene.objects[*open].shapes));
  scene.shapes.erase(begin, scene.shapes.end());
}

}  // namespace caplet::pbrt
