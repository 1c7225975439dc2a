// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "caplet/scene.h"

#include <fmt/format.h>

#include "library/detail/inside.h"
#include "present/film_window.h"

namespace caplet::v0 {

namespace {

constexpr int most_samples = 1 << 24, most_events = 1 << 16;
constexpr std::int64_t most_pixels = std::int64_t{1} << 28;

void check_range(const char* what, std::int64_t value, std::int64_t least, std::int64_t most) {
  if (value < least || value > most) throw InputError(fmt::format("{}: {} is not within {} to {}", what, value, least, most));
}

}  // namespace

Scene::Scene(std::shared_ptr<Data> data) : data_(std::move(data)) {}
Scene::Scene(const Scene&) = default;
Scene::Scene(Scene&&) noexcept = default;
Scene& Scene::operator=(const Scene&) = default;
Scene& Scene::operator=(Scene&&) noexcept = default;
Scene::~Scene() = default;

Scene::Data& Scene::changed() {
  if (data_.use_count() > 1) data_ = std::make_shared<Data>(*data_);
  return *data_;
}

Bounds Scene::bounds() const {
  const caplet::Bounds bounds = bounds_of(data_->model);
  return {{bounds.min.x, bounds.min.y, bounds.min.z}, {bounds.max.x, bounds.max.y, bounds.max.z}};
}

std::map<std::string, std::uint64_t> Scene::primitives() const { return count_primitives(data_->model); }

std::vector<std::string> Scene::materials() const {
  std::vector<std::string> out;
  for (const Material& material : data_->model.materials) out.push_back(material.name);
  return out;
}

int Scene::width() const { return data_->model.film.width; }
int Scene::height() const { return data_->model.film.height; }

void Scene::set_size(int width, int height) {
  check_range("width", width, 1, most_pixels);
  check_range("height", height, 1, most_pixels / width);
  set_film_size(changed().model, width, height);
}

void Scene::set_crop(int x0, int y0, int x1, int y1) { caplet::set_crop(changed().model, {x0, y0, x1, y1}); }

int Scene::samples_per_pixel() const { return data_->model.sampler.samples_per_pixel; }
void Scene::set_samples_per_pixel(int samples) {
  check_range("samples per pixel", samples, 1, most_samples);
  changed().model.sampler.samples_per_pixel = samples;
}

int Scene::max_depth() const { return data_->model.integrator.max_depth; }
void Scene::set_max_depth(int events) {
  check_range("scattering events", events, 0, most_events);
  changed().model.integrator.max_depth = events;
}

std::uint32_t Scene::seed() const { return data_->model.sampler.seed; }
void Scene::set_seed(std::uint32_t seed) { changed().model.sampler.seed = seed; }

}  // namespace caplet::v0
