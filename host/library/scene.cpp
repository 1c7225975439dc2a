// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "caplet/scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <numbers>

#include "base/spelling.h"
#include "base/utf8.h"
#include "import/color_map.h"
#include "library/detail/appearance.h"
#include "library/detail/inside.h"
#include "library/detail/places.h"
#include "present/film_window.h"
#include "present/least_width.h"
#include "present/open_shutter.h"

namespace caplet::v0 {

namespace {

constexpr int most_samples = 1 << 24, most_events = 1 << 16;
// A session with more edits to catch up on takes the whole scene again.
constexpr std::size_t most_logged = 1 << 16;
constexpr double degrees_per_radian = 180 / std::numbers::pi;

template <class T>
const T& at(const std::vector<T>& values, std::size_t number, const char* what) {
  if (number < values.size()) return values[number];
  throw InputError(
      fmt::format("there is no {} {}, of {} counted from 0", what, number, values.size()));
}

glm::dvec3 to_vector(const std::array<double, 3>& v) { return {v[0], v[1], v[2]}; }

}  // namespace

std::uint64_t next_serial() {
  static std::atomic<std::uint64_t> last = 0;
  return ++last;
}

void Scene::Data::edit(const SceneEdit& edit) {
  apply_edit(model, edit);
  if (log.size() == most_logged) {
    as_a_whole();
  } else {
    log.add(edit, next_serial());
  }
}

void Scene::Data::as_a_whole() { log.restart(next_serial()); }

void Scene::Data::as_a_whole_in_view() {
  const bool is_presented = presented == log.origin();
  as_a_whole();
  if (is_presented) presented = log.origin();
}

void check_range(const char* what, std::int64_t value, std::int64_t least, std::int64_t most) {
  if (value < least || value > most)
    throw InputError(fmt::format("{}: {} is not within {} to {}", what, value, least, most));
}

Scene::Scene(std::shared_ptr<Data> data) : data_(std::move(data)) {}
Scene::Scene(const Scene&) = default;
Scene::Scene(Scene&&) noexcept = default;
Scene& Scene::operator=(const Scene&) = default;
Scene& Scene::operator=(Scene&&) noexcept = default;
Scene::~Scene() = default;

Scene::Data& Scene::changed() {
  if (data_.use_count() > 1) data_ = std::make_shared<Data>(*data_);
  std::atomic_thread_fence(std::memory_order_acquire);  // makes accesses of other threads through
                                                        // released copies happen before
  return *data_;
}

Bounds Scene::bounds() const {
  const caplet::Bounds bounds = bounds_of(data_->model);
  return {{bounds.min.x, bounds.min.y, bounds.min.z}, {bounds.max.x, bounds.max.y, bounds.max.z}};
}

std::map<std::string, std::uint64_t> Scene::primitives() const {
  return count_primitives(data_->model);
}

std::vector<std::string> Scene::materials() const {
  std::vector<std::string> out;
  for (const caplet::Material& material : data_->model.materials) out.push_back(material.name);
  return out;
}

int Scene::width() const { return data_->model.view.film.width; }
int Scene::height() const { return data_->model.view.film.height; }

void Scene::set_size(int width, int height) {
  check_range("width", width, 1, most_image_pixels);
  check_range("height", height, 1, most_image_pixels / width);
  set_film_size(changed().model, width, height);
}

void Scene::set_crop(int x0, int y0, int x1, int y1) {
  caplet::set_crop(changed().model, {x0, y0, x1, y1});
}

int Scene::samples_per_pixel() const { return data_->model.view.sampler.samples_per_pixel; }
void Scene::set_samples_per_pixel(int samples) {
  check_range("samples per pixel", samples, 1, most_samples);
  SamplerSettings& sampler = changed().model.view.sampler;
  sampler.samples_per_pixel = samples;
  sampler.noise = 0;
}

double Scene::noise() const { return data_->model.view.sampler.noise; }

std::optional<NoiseTarget> Scene::noise_target() const {
  const SamplerSettings& sampler = data_->model.view.sampler;
  const int most = sampler.samples_per_pixel;
  if (!(sampler.noise > 0) || most < 2) return {};
  const PreviewExposure& exposure = data_->model.view.film.exposure;
  return NoiseTarget{sampler.noise, std::min(NoiseTarget{}.least_samples, most), most,
                     sampler.space() == NoiseSpace::display,
                     exposure.is_automatic ? 0 : exposure.stops};
}

int Scene::max_depth() const { return data_->model.view.integrator.max_depth; }
void Scene::set_max_depth(int events) {
  check_range("scattering events", events, 0, most_events);
  changed().model.view.integrator.max_depth = events;
}

std::uint32_t Scene::seed() const { return data_->model.view.sampler.seed; }
void Scene::set_seed(std::uint32_t seed) { changed().model.view.sampler.seed = seed; }

std::string Scene::unit() const { return data_->model.unit; }

void Scene::set_unit(const std::string& unit) {
  Data& data = changed();
  data.model.unit = valid_utf8(unit);
  data.as_a_whole_in_view();
}

void Scene::set_color_bar(const std::string& title, const std::string& unit, double low,
                          double high) {
  if (!(low <= high) || !std::isfinite(low) || !std::isfinite(high))
    throw InputError("the ends of a colour bar are two numbers, the first not above the second");
  Data& data = changed();
  data.model.legend = map_legend(valid_utf8(title), valid_utf8(unit), low, high);
  data.as_a_whole_in_view();
}

std::vector<std::string> Scene::shapes() const {
  std::vector<std::string> out;
  for (const Shape& shape : data_->model.shapes) out.push_back(shape.name);
  for (const Object& object : data_->model.objects)
    for (const Shape& shape : object.shapes) out.push_back(shape.name);
  return out;
}

std::uint32_t Scene::shape(const std::string& name) const {
  const std::vector<std::string> names = shapes();
  const auto found = std::ranges::find(names, valid_utf8(name));
  if (found == names.end())
    throw InputError(fmt::format("there is no shape '{}'; the nearest is '{}'", name,
                                 nearest_name(name, names)));
  if (std::find(found + 1, names.end(), *found) != names.end())
    throw InputError(fmt::format("several shapes are named '{}'", name));
  return static_cast<std::uint32_t>(found - names.begin());
}

std::size_t Scene::capsules(std::uint32_t shape) const {
  const auto* capsules =
      std::get_if<CapsulesShape>(&shape_at(data_->model, place_of(data_->model, shape)).geometry);
  return capsules ? count_of(*capsules) : 0;
}

Capsule Scene::capsule(std::uint32_t shape, std::size_t capsule) const {
  const caplet::Capsule found = capsule_at(data_->model, place_of(data_->model, shape), capsule);
  return {{found.p0.x, found.p0.y, found.p0.z},
          {found.p1.x, found.p1.y, found.p1.z},
          found.radius0,
          found.radius1};
}

void Scene::set_capsule(std::uint32_t shape, std::size_t capsule, const Capsule& to) {
  const auto vector = [](const std::array<float, 3>& v) { return glm::vec3(v[0], v[1], v[2]); };
  const caplet::Capsule model{vector(to.p0), vector(to.p1), to.radius0, to.radius1};
  changed().edit(CapsuleEdit{place_of(data_->model, shape), capsule, model});
}

Transform Scene::transform(std::uint32_t shape) const {
  return to_public(shape_at(data_->model, place_of(data_->model, shape)).world_from_object);
}
void Scene::set_transform(std::uint32_t shape, const Transform& to) {
  changed().edit(TransformEdit{place_of(data_->model, shape), to_model(to)});
}

std::size_t Scene::instances() const { return data_->model.instances.size(); }
Transform Scene::instance(std::uint32_t instance) const {
  return to_public(at(data_->model.instances, instance, "instance").world_from_object);
}
void Scene::set_instance(std::uint32_t instance, const Transform& to) {
  changed().edit(InstanceEdit{instance, to_model(to)});
}
void Scene::set_instance_motion(std::uint32_t instance, const std::vector<double>& times,
                                std::span<const Transform> transforms,
                                const std::array<double, 3>& pivot) {
  const TransformKeys keys = keys_of(times, transforms);
  const glm::dmat4 place = keys.empty()
                               ? at(data_->model.instances, instance, "instance").world_from_object
                               : keys.front().matrix;
  changed().edit(InstanceEdit{instance, place, keys, to_vector(pivot)});
}

void Scene::set_material(std::uint32_t material, const Material& to) {
  caplet::Material made = to_model(to, data_->model);
  check_bends(data_->model, made);
  const MaterialEdit edit{material, std::move(made.model), std::move(made.textures)};
  Data& data = changed();
  data.edit(edit);
  caplet::Material& now = data.model.materials[material];
  if (now.displacement == made.displacement && now.normalmap == made.normalmap) return;
  if (!std::holds_alternative<NamedMaterial>(to)) return;
  now.displacement = made.displacement;
  now.normalmap = made.normalmap;
  data.as_a_whole();
}

std::uint32_t Scene::add_material(const std::string& name, const Material& material) {
  caplet::Material made = to_model(material, data_->model);
  check_bends(data_->model, made);
  made.name = valid_utf8(name);
  Data& data = changed();
  const auto number = static_cast<std::uint32_t>(data.model.materials.size());
  data.model.materials.push_back(made);
  try {
    check_edit(data.model, MaterialEdit{number, made.model, made.textures});
  } catch (...) {
    data.model.materials.pop_back();
    throw;
  }
  data.as_a_whole();
  return number;
}

TextureNumber Scene::add_texture(const NamedTexture& texture) {
  caplet::Texture made = to_model(texture, data_->model);
  Data& data = changed();
  const auto number = static_cast<std::uint32_t>(data.model.textures.size());
  data.model.textures.push_back(std::move(made));
  try {
    caplet::Scene one;
    one.textures = data.model.textures;
    check_textures(one);
  } catch (...) {
    data.model.textures.pop_back();
    throw;
  }
  data.as_a_whole();
  return {number};
}

std::size_t Scene::lights() const { return data_->model.lights.size(); }
double Scene::light_scale(std::uint32_t light) const {
  return at(data_->model.lights, light, "light").scale;
}

void Scene::set_light(std::uint32_t light, const Spectrum& color, double scale) {
  Light to = at(data_->model.lights, light, "light");
  to.scale = scale;
  const caplet::Spectrum spectrum = to_model(color);
  std::visit(
      [&](auto& model) {
        if constexpr (requires { model.intensity; }) model.intensity = spectrum;
        if constexpr (requires { model.irradiance; }) model.irradiance = spectrum;
        if constexpr (requires { model.radiance; }) model.radiance = spectrum;
      },
      to.model);
  changed().edit(LightEdit{light, to});
}

void Scene::set_emission(std::uint32_t shape, const Spectrum& radiance, double scale) {
  const ShapeAt place = place_of(data_->model, shape);
  const Shape& found = shape_at(data_->model, place);
  if (!found.emission) throw InputError(found.where, "the shape is no light");
  AreaEmission to = *found.emission;
  to.radiance = to_model(radiance);
  to.scale = scale;
  changed().edit(EmissionEdit{place, to});
}

void Scene::look_at(const std::array<double, 3>& eye, const std::array<double, 3>& target,
                    const std::array<double, 3>& up) {
  // pbrt's LookAt mirrors a right-handed world; this is kept only if the present camera mirrors it
  // too.
  const bool is_mirrored =
      !data_->open_camera &&
      glm::determinant(glm::dmat3(data_->model.view.camera.world_from_camera)) > 0;
  auto world_from_camera = camera_looking(to_vector(eye), to_vector(target), to_vector(up));
  if (!world_from_camera)
    throw InputError(
        "the camera has no direction: eye and target coincide, or up lies along the view");
  if (!is_mirrored) (*world_from_camera)[0] *= -1;
  View view = data_->model.view;
  view.camera.world_from_camera = *world_from_camera;
  view.camera.motion.clear();
  apply_edit(changed().model, view);
  changed().model.automatic_camera = false;
  changed().open_camera = false;
}

void Scene::widen_to_least() {
  if (!(data_->model.view.film.least_width > 0)) return;
  if (data_->open_camera) present();
  Data& data = changed();
  if (caplet::widen_to_least(data.model) > 0) data.as_a_whole_in_view();
}

void Scene::set_camera_motion(const std::vector<double>& times,
                              std::span<const Transform> transforms) {
  View view = data_->model.view;
  view.camera.motion = keys_of(times, transforms);
  if (!view.camera.motion.empty())
    view.camera.world_from_camera = view.camera.motion.front().matrix;
  apply_edit(changed().model, view);
  changed().model.automatic_camera = false;
  changed().open_camera = false;
}

void Scene::set_shutter(double open, double close) {
  if (!(std::isfinite(open) && std::isfinite(close) && close > open))
    throw InputError(
        fmt::format("a shutter opens before it closes, not at {} and {}", open, close));
  View view = data_->model.view;
  view.film.shutter_open = open;
  expose(view.film, close - open);
  apply_edit(changed().model, view);
}

double Scene::fov() const { return fov_of(data_->model.view.camera) * degrees_per_radian; }
void Scene::set_fov(double degrees) {
  if (data_->open_camera) present();
  View view = data_->model.view;
  view.camera.projection = PerspectiveProjection{degrees / degrees_per_radian};
  apply_edit(changed().model, view);
  changed().model.automatic_camera = false;
  changed().open_camera = false;
}

}  // namespace caplet::v0
