// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Scenes that programs build: statements are read as in scene files, and shapes are added in bulk.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/spelling.h"
#include "base/utf8.h"
#include "caplet/scene.h"
#include "film/image.h"
#include "import/statement.h"
#include "library/detail/appearance.h"
#include "library/detail/inside.h"
#include "library/detail/places.h"
#include "library/detail/statements.h"
#include "present/present.h"
#include "scene/part_materials.h"

namespace caplet::v0 {

namespace {

const char* directive_of(Statement statement) {
  switch (statement) {
    case Statement::shape:
      return "Shape";
    case Statement::light:
      return "LightSource";
    case Statement::emission:
      return "AreaLightSource";
    case Statement::medium:
      return "MakeNamedMedium";
    case Statement::camera:
      return "Camera";
    case Statement::film:
      return "Film";
    case Statement::filter:
      return "PixelFilter";
    case Statement::sampler:
      return "Sampler";
    case Statement::integrator:
      return "Integrator";
    case Statement::material:
      return "Material";
    case Statement::texture:
      return "Texture";
  }
  return "";
}

std::size_t length_of(const Parameter& parameter) {
  if (const auto* numbers = std::get_if<std::vector<double>>(&parameter)) return numbers->size();
  if (const auto* names = std::get_if<std::vector<std::string>>(&parameter)) return names->size();
  return 0;
}

std::vector<glm::vec3> points_of(const std::vector<std::array<float, 3>>& points) {
  std::vector<glm::vec3> out(points.size());
  std::ranges::transform(points, out.begin(),
                         [](const auto& p) { return glm::vec3(p[0], p[1], p[2]); });
  return out;
}

std::vector<std::array<float, 3>> arrays_of(const std::vector<glm::vec3>& points) {
  std::vector<std::array<float, 3>> out(points.size());
  std::ranges::transform(points, out.begin(), [](const auto& p) {
    return std::array<float, 3>{p.x, p.y, p.z};
  });
  return out;
}

CapsulesShape geometry_of(const CapsuleArrays& arrays) {
  const std::size_t times = std::max<std::size_t>(1, arrays.times.size());
  const std::size_t count = arrays.p0.size();
  const auto check = [&](const char* name, std::size_t given, bool may_be_none,
                         std::size_t at_times = 1) {
    if (given * at_times != count && !(may_be_none && given == 0))
      throw InputError(fmt::format("capsules: {} has {} entries, and p0 {}{}", name, given, count,
                                   at_times > 1 ? fmt::format(" at {} times", times) : ""));
  };
  check("p1", arrays.p1.size(), false);
  check("radius0", arrays.radius0.size(), false);
  check("radius1", arrays.radius1.size(), true);
  check("materials", arrays.materials.size(), true, times);
  check("u", arrays.u.size(), true, times);
  if (count == 0) throw InputError("capsules: there are none");
  CapsulesShape out{points_of(arrays.p0), points_of(arrays.p1), arrays.radius0, arrays.radius1,
                    arrays.materials};
  if (out.radius1 == out.radius0) out.radius1.clear();
  for (const auto& u : arrays.u) out.u.emplace_back(u[0], u[1]);
  out.times = arrays.times;
  return out;
}

TriangleMeshShape geometry_of(const MeshArrays& arrays) {
  TriangleMeshShape out{
      points_of(arrays.positions), arrays.triangles, points_of(arrays.normals), {}, arrays.times};
  for (const auto& uv : arrays.uvs) out.uvs.emplace_back(uv[0], uv[1]);
  if (out.triangles.empty()) throw InputError("mesh: it has no triangles");
  return out;
}

std::vector<Shape>& shapes_for(caplet::Scene& scene, const std::string& object) {
  if (object.empty()) return scene.shapes;
  const auto found = std::ranges::find(scene.objects, valid_utf8(object), &Object::name);
  if (found != scene.objects.end()) return found->shapes;
  Object& made = scene.objects.emplace_back();
  made.name = valid_utf8(object);
  return made.shapes;
}

std::size_t object_at(const caplet::Scene& scene, const std::string& object) {
  const auto found = std::ranges::find(scene.objects, valid_utf8(object), &Object::name);
  if (found != scene.objects.end()) return static_cast<std::size_t>(found - scene.objects.begin());
  std::vector<std::string> names;
  for (const Object& one : scene.objects) names.push_back(one.name);
  throw InputError(names.empty() ? fmt::format("there is no object '{}'", object)
                                 : fmt::format("there is no object '{}'; the nearest is '{}'",
                                               object, nearest_name(object, names)));
}

std::uint32_t number_in(const caplet::Scene& scene, const std::string& object, std::size_t index) {
  std::size_t number = index;
  if (!object.empty()) {
    number += scene.shapes.size();
    for (std::size_t i = 0, at = object_at(scene, object); i < at; ++i)
      number += scene.objects[i].shapes.size();
  }
  return static_cast<std::uint32_t>(number);
}

std::uint32_t greatest_material(const Shape& shape) {
  std::uint32_t most = shape.material;
  for (const std::uint32_t material : shape.materials) most = std::max(most, material);
  if (const auto* parts = part_materials(shape))
    for (const std::uint32_t material : *parts) most = std::max(most, material);
  return most;
}

/// Throws the errors of validate() for these shapes with only what they refer to. Leaves the shapes
/// as they are.
void check_shapes(const caplet::Scene& scene, std::vector<Shape>& shapes) {
  std::uint32_t most = 0;
  bool textured = false;
  for (const Shape& shape : shapes) {
    most = std::max(most, greatest_material(shape));
    textured = textured || (shape.alpha && shape.alpha->texture);
  }
  if (most >= std::max<std::size_t>(scene.materials.size(), 1))
    throw InputError(
        fmt::format("there is no material {}, of {} counted from 0", most, scene.materials.size()));
  caplet::Scene one;
  one.materials.resize(std::size_t{most} + 1);
  for (const Shape& shape : shapes)
    for (const auto& side : {shape.media.inside, shape.media.outside})
      if (side && *side >= scene.media.size())
        throw InputError(
            fmt::format("there is no medium {}, of {} counted from 0", *side, scene.media.size()));
  one.media.resize(scene.media.size());
  if (textured) one.textures = scene.textures;
  one.shapes.swap(shapes);
  Diagnostics diagnostics;
  validate(one, diagnostics);
  one.shapes.swap(shapes);
  diagnostics.finish();
}

/// Returns a shape of the scene with another geometry; throws where that is not valid.
Shape with_geometry(const caplet::Scene& scene, const ShapeAt& place, Geometry geometry) {
  std::vector<Shape> one{shape_at(scene, place)};
  one[0].geometry = std::move(geometry);
  check_shapes(scene, one);
  return std::move(one[0]);
}

void set_options(const ShapeOptions& options, const std::optional<AreaEmission>& emission,
                 Shape& shape) {
  if (!options.name.empty()) shape.name = valid_utf8(options.name);
  shape.world_from_object = to_model(options.transform);
  if (options.materials.size() > 1) shape.materials = options.materials;
  if (!options.materials.empty()) shape.material = options.materials[0];
  shape.emission = emission;
  shape.media = {options.inside, options.outside};
  shape.reverse_orientation = options.reverse_orientation;
}

std::optional<AreaEmission> emission_for(const ShapeOptions& options) {
  if (!options.emission) return std::nullopt;
  return emission_of(to_statement(directive_of(Statement::emission), "diffuse", *options.emission),
                     FileImageReader());
}

/// Adds the default material of shapes.
void need_material(caplet::Scene& scene) {
  if (scene.materials.empty()) scene.materials.emplace_back().name = "default";
}

/// Adds valid shapes, and returns the number of the first.
std::uint32_t add(caplet::Scene& scene, std::vector<Shape> shapes, const std::string& object) {
  check_shapes(scene, shapes);
  need_material(scene);
  std::vector<Shape>& to = shapes_for(scene, object);
  const std::size_t first = to.size();
  to.insert(to.end(), std::make_move_iterator(shapes.begin()),
            std::make_move_iterator(shapes.end()));
  return number_in(scene, object, first);
}

std::vector<Shape> one_of(Geometry geometry, const ShapeOptions& options) {
  std::vector<Shape> shapes(1);
  shapes[0].geometry = std::move(geometry);
  set_options(options, emission_for(options), shapes[0]);
  return shapes;
}

void check_light(const caplet::Light& light) {
  caplet::Scene one;
  one.lights.push_back(light);
  check_textures(one);
}

}  // namespace

std::vector<std::string> statement_types(Statement statement) {
  return caplet::statement_types(directive_of(statement));
}

std::vector<KnownParameter> statement_parameters(Statement statement, const std::string& type) {
  std::vector<KnownParameter> out;
  for (schema::Parameter& one : caplet::statement_parameters(directive_of(statement), type)) {
    KnownParameter& to =
        out.emplace_back(KnownParameter{std::move(one.name), std::move(one.types)});
    to.doc = std::move(one.doc);
    to.fallback = std::move(one.fallback);
    to.low = one.low;
    to.high = one.high;
    to.above_low = one.above_low;
    to.unit = std::move(one.unit);
    to.choices = std::move(one.choices);
    to.excludes = std::move(one.excludes);
    to.has_effect = one.has_effect;
    // A program first makes a texture of the image.
    if (statement == Statement::material && to.name == "normalmap") to.types = {"texture"};
  }
  if (statement == Statement::texture &&
      std::ranges::find(out, "filename", &KnownParameter::name) != out.end()) {
    KnownParameter& pixels = out.emplace_back(KnownParameter{"pixels", {}});
    pixels.doc = "an image in memory: rows of pixels of 1, 3 or 4 numbers";
    pixels.excludes = {"filename", "encoding"};
  }
  return out;
}

Scene::Scene() : data_(std::make_shared<Data>()) { data_->open_camera = data_->open_light = true; }

std::uint32_t Scene::add_shape(const std::string& type, const Parameters& parameters,
                               const ShapeOptions& options) {
  return add_shapes(type, 1, parameters, {}, {}, {}, options);
}

std::uint32_t Scene::add_shapes(const std::string& type, std::size_t count,
                                const Parameters& shared, const Parameters& each,
                                std::span<const Transform> transforms,
                                std::span<const std::uint32_t> materials,
                                const ShapeOptions& options) {
  if (count == 0) throw InputError(fmt::format("{}: there are none", type));
  if (!transforms.empty() && transforms.size() != count)
    throw InputError(
        fmt::format("{}: {} transforms for {} shapes", type, transforms.size(), count));
  if (!materials.empty() && materials.size() != count)
    throw InputError(fmt::format("{}: {} materials for {} shapes", type, materials.size(), count));
  for (const auto& [name, values] : each)
    if (const std::size_t given = length_of(values); given == 0 || given % count != 0)
      throw InputError(
          fmt::format("{}: '{}' has {} values for {} shapes", type, name, given, count));
  const caplet::Scene& model = data_->model;
  const std::optional<AreaEmission> emission = emission_for(options);
  const std::uint32_t material = options.materials.empty() ? 0 : options.materials[0];
  ProgramStatement statement = to_statement(directive_of(Statement::shape), type, shared);
  const std::size_t own = statement.parameters.size();
  for (const auto& [name, values] : each) statement.parameters.emplace_back().name = name;
  std::vector<Shape> shapes;
  shapes.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    std::size_t at = own;
    for (const auto& [name, values] : each) {
      const std::size_t width = length_of(values) / count;
      put_values(type, values, statement.parameters[at++], i * width, width);
    }
    Shape shape = shape_of(statement, material, model);
    set_options(options, emission, shape);
    if (!transforms.empty()) shape.world_from_object = to_model(transforms[i]);
    if (!materials.empty()) shape.material = materials[i];
    caplet::make_hair_one_sided(statement, model, shape);
    shapes.push_back(std::move(shape));
  }
  Data& data = changed();
  const std::uint32_t number = add(data.model, std::move(shapes), options.object);
  data.as_a_whole();
  return number;
}

std::uint32_t Scene::add_capsules(const CapsuleArrays& capsules, const ShapeOptions& options) {
  std::vector<Shape> shapes = one_of(geometry_of(capsules), options);
  caplet::make_hair_one_sided({}, data_->model, shapes[0]);
  Data& data = changed();
  const std::uint32_t number = add(data.model, std::move(shapes), options.object);
  data.as_a_whole();
  return number;
}

std::uint32_t Scene::add_molecular_surface(const BallArrays& balls, double probe,
                                           const ShapeOptions& options) {
  if (balls.centers.empty()) throw InputError("molecular surface: there are no balls");
  std::vector<Shape> shapes =
      one_of(make_molecule(points_of(balls.centers), balls.radii, probe, balls.materials), options);
  Data& data = changed();
  const std::uint32_t number = add(data.model, std::move(shapes), options.object);
  data.as_a_whole();
  return number;
}

std::uint32_t Scene::add_mesh(const MeshArrays& mesh, const ShapeOptions& options) {
  std::vector<Shape> shapes = one_of(geometry_of(mesh), options);
  Data& data = changed();
  const std::uint32_t number = add(data.model, std::move(shapes), options.object);
  data.as_a_whole();
  return number;
}

CapsuleArrays Scene::capsule_arrays(std::uint32_t shape) const {
  const auto* found =
      std::get_if<CapsulesShape>(&shape_at(data_->model, place_of(data_->model, shape)).geometry);
  if (!found) throw InputError(fmt::format("shape {} is not one of capsules", shape));
  CapsuleArrays out{arrays_of(found->p0), arrays_of(found->p1), found->radius0, found->radius1,
                    found->materials};
  for (const glm::vec2& u : found->u) out.u.push_back({u.x, u.y});
  out.times = found->times;
  return out;
}

void Scene::set_capsules(std::uint32_t shape, const CapsuleArrays& capsules) {
  const ShapeAt place = place_of(data_->model, shape);
  if (!std::holds_alternative<CapsulesShape>(shape_at(data_->model, place).geometry))
    throw InputError(fmt::format("shape {} is not one of capsules", shape));
  Shape other = with_geometry(data_->model, place, geometry_of(capsules));
  Data& data = changed();
  const_cast<Shape&>(shape_at(data.model, place)) = std::move(other);
  data.as_a_whole_in_view();
}

MeshArrays Scene::mesh_arrays(std::uint32_t shape) const {
  const auto* found = std::get_if<TriangleMeshShape>(
      &shape_at(data_->model, place_of(data_->model, shape)).geometry);
  if (!found) throw InputError(fmt::format("shape {} is not a mesh of triangles", shape));
  MeshArrays out{
      arrays_of(found->positions), found->triangles, arrays_of(found->normals), {}, found->times};
  for (const glm::vec2& uv : found->uvs) out.uvs.push_back({uv.x, uv.y});
  return out;
}

void Scene::set_mesh(std::uint32_t shape, const MeshArrays& mesh) {
  const ShapeAt place = place_of(data_->model, shape);
  if (!std::holds_alternative<TriangleMeshShape>(shape_at(data_->model, place).geometry))
    throw InputError(fmt::format("shape {} is not a mesh of triangles", shape));
  Shape other = with_geometry(data_->model, place, geometry_of(mesh));
  Data& data = changed();
  const_cast<Shape&>(shape_at(data.model, place)) = std::move(other);
  data.as_a_whole_in_view();
}

void Scene::set_operand_motion(std::uint32_t shape, std::size_t operand,
                               const std::vector<double>& times,
                               std::span<const Transform> transforms) {
  const ShapeAt place = place_of(data_->model, shape);
  const auto* found = std::get_if<CsgShape>(&shape_at(data_->model, place).geometry);
  if (!found) throw InputError(fmt::format("shape {} is not a csg", shape));
  if (operand >= found->operands.size())
    throw InputError(fmt::format("there is no operand {}, of {} counted from 0", operand,
                                 found->operands.size()));
  CsgShape csg = *found;
  csg.motions.resize(csg.operands.size());
  const TransformKeys& keys = csg.motions[operand] = keys_of(times, transforms);
  if (!keys.empty()) {
    auto moved = std::make_shared<Shape>(*csg.operands[operand]);
    moved->world_from_object = keys.front().matrix;
    csg.operands[operand] = std::move(moved);
  }
  if (std::ranges::all_of(csg.motions, &TransformKeys::empty)) csg.motions.clear();
  Shape other = with_geometry(data_->model, place, std::move(csg));
  Data& data = changed();
  const_cast<Shape&>(shape_at(data.model, place)) = std::move(other);
  data.as_a_whole_in_view();
}

std::uint32_t Scene::shape_in(const std::string& object, std::size_t index) const {
  const caplet::Scene& model = data_->model;
  const std::size_t count =
      object.empty() ? model.shapes.size() : model.objects[object_at(model, object)].shapes.size();
  if (index >= count)
    throw InputError(fmt::format("there is no shape {}, of {} counted from 0", index, count));
  return number_in(model, object, index);
}

std::pair<std::string, std::size_t> Scene::place(std::uint32_t shape) const {
  const ShapeAt at = place_of(data_->model, shape);
  return {at.object ? data_->model.objects[*at.object].name : std::string(), at.shape};
}

void Scene::set_shape_materials(std::uint32_t shape, const std::vector<std::uint32_t>& materials) {
  if (materials.empty()) throw InputError("a shape has a material");
  const ShapeAt place = place_of(data_->model, shape);
  std::vector<Shape> one{shape_at(data_->model, place)};
  one[0].material = materials[0];
  one[0].materials = materials.size() > 1 ? materials : std::vector<std::uint32_t>{};
  if (auto* parts = part_materials(one[0])) parts->clear();
  check_shapes(data_->model, one);
  Data& data = changed();
  const_cast<Shape&>(shape_at(data.model, place)) = std::move(one[0]);
  data.as_a_whole_in_view();
}

std::vector<std::string> Scene::objects() const {
  std::vector<std::string> out;
  for (const Object& object : data_->model.objects) out.push_back(object.name);
  return out;
}

std::uint32_t Scene::add_instances(const std::string& object,
                                   std::span<const Transform> transforms) {
  const auto number = static_cast<std::uint32_t>(object_at(data_->model, object));
  caplet::Scene one;
  one.objects.push_back(data_->model.objects[number]);
  std::uint32_t most = 0;
  for (const Shape& shape : one.objects[0].shapes) most = std::max(most, greatest_material(shape));
  one.materials.resize(std::size_t{most} + 1);
  one.media.resize(data_->model.media.size());
  one.textures = data_->model.textures;
  for (const Transform& transform : transforms)
    one.instances.push_back({0, to_model(transform), {}});
  if (one.instances.empty()) throw InputError("instances: there are none");
  Diagnostics diagnostics;
  validate(one, diagnostics);
  diagnostics.finish();
  Data& data = changed();
  const auto first = static_cast<std::uint32_t>(data.model.instances.size());
  for (Instance& instance : one.instances)
    data.model.instances.push_back({number, instance.world_from_object, {}});
  data.as_a_whole();
  return first;
}

std::uint32_t Scene::add_light(const std::string& type, const Parameters& parameters,
                               const Transform& transform) {
  caplet::Light light = light_of(to_statement(directive_of(Statement::light), type, parameters),
                                 to_model(transform), FileImageReader());
  check_light(light);
  Data& data = changed();
  if (data.studio_light) data.model.lights.clear();
  data.open_light = data.studio_light = false;
  data.model.lights.push_back(std::move(light));
  data.as_a_whole();
  return static_cast<std::uint32_t>(data.model.lights.size() - 1);
}

void Scene::remove_lights() {
  Data& data = changed();
  data.model.lights.clear();
  data.open_light = data.studio_light = false;
  data.as_a_whole();
}

std::uint32_t Scene::add_medium(const std::string& name, const std::string& type,
                                const Parameters& parameters, const Transform& transform) {
  caplet::Medium medium = medium_of(to_statement(directive_of(Statement::medium), type, parameters),
                                    valid_utf8(name), to_model(transform));
  caplet::Scene one;
  one.media.push_back(medium);
  check_textures(one);
  Data& data = changed();
  data.model.media.push_back(std::move(medium));
  data.as_a_whole();
  return static_cast<std::uint32_t>(data.model.media.size() - 1);
}

std::vector<std::string> Scene::media() const {
  std::vector<std::string> out;
  for (const caplet::Medium& medium : data_->model.media) out.push_back(medium.name);
  return out;
}

void Scene::set_camera(const std::string& type, const Parameters& parameters,
                       const Transform& transform) {
  caplet::Scene one;
  one.view.film = data_->model.view.film;
  caplet::set_option(to_statement(directive_of(Statement::camera), type, parameters),
                     to_model(transform), one);
  check_textures(one);
  Data& data = changed();
  one.view.camera.medium = data.model.view.camera.medium;
  data.model.view.camera = one.view.camera;
  data.model.view.clip = one.view.clip;
  data.model.view.film.exposure_time = one.view.film.exposure_time;
  data.model.view.film.shutter_open = one.view.film.shutter_open;
  data.model.view.film.readout = one.view.film.readout;
  data.model.view.film.readout_order = one.view.film.readout_order;
  data.model.automatic_camera = one.automatic_camera;
  data.model.has_no_up = one.has_no_up;
  data.model.framing = one.framing;
  if (!one.unit.empty()) data.model.unit = one.unit;
  data.open_camera = false;
  if (data.model.automatic_camera && can_be_framed(data.model)) frame_camera(data.model);
}

Transform Scene::camera() const { return to_public(data_->model.view.camera.world_from_camera); }

void Scene::set_camera_medium(std::optional<std::uint32_t> medium) {
  if (medium && *medium >= data_->model.media.size())
    throw InputError(fmt::format("there is no medium {}, of {} counted from 0", *medium,
                                 data_->model.media.size()));
  Data& data = changed();
  data.model.view.camera.medium = medium;
  data.as_a_whole();
}

void Scene::set_option(Statement statement, const std::string& type, const Parameters& parameters) {
  if (statement != Statement::film && statement != Statement::filter &&
      statement != Statement::sampler && statement != Statement::integrator)
    throw InputError("an option is a film, a filter, a sampler or an integrator");
  caplet::Scene one;
  one.view = data_->model.view;
  caplet::set_option(to_statement(directive_of(statement), type, parameters), glm::dmat4(1), one);
  check_textures(one);
  Data& data = changed();
  const bool sky_changes =
      data.model.view.film.backdrop.has_value() != one.view.film.backdrop.has_value();
  data.model.view = one.view;
  if (data.model.automatic_camera && statement == Statement::film) frame_camera(data.model);
  if (sky_changes) data.as_a_whole();
}

void Scene::present() {
  if (data_->presented == data_->log.origin()) return;
  Data& data = changed();
  caplet::Scene& model = data.model;
  if (model.shapes.empty() && model.instances.empty() && data.open_camera && !is_lit(model))
    throw InputError("the scene is empty: it has no shapes, no light and no camera");
  Diagnostics diagnostics;
  validate(model, diagnostics);
  diagnostics.finish();
  if (data.studio_light) model.lights.clear();
  const bool needs_light = data.open_light && !is_lit(model);
  const caplet::Camera camera = model.view.camera;
  if (needs_light)
    add_presentation(model);
  else if (data.open_camera)
    frame_camera(model);
  if (!data.open_camera) {
    model.view.camera = camera;
    model.automatic_camera = false;
    // The studio's lights are placed around this camera.
    const glm::dmat3 view(camera.world_from_camera);
    if (needs_light)
      std::get<InfiniteLight>(model.lights.back().model).world_from_light =
          glm::dmat3(-view[2], view[0], view[1]);
  }
  data.studio_light = needs_light;
  if (needs_light || data.open_camera) data.as_a_whole();
  data.presented = data.log.origin();
}

}  // namespace caplet::v0
