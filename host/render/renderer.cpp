// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "render/renderer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/check.h"

namespace caplet {

namespace {

// 2^17 paths: enough rays for sorting to find neighbours, 30 MB of state (docs/performance.md).
constexpr std::size_t cpu_batch_paths = std::size_t{1} << 17;
constexpr std::size_t gpu_batch_paths = std::size_t{1} << 20;

// A tree of fewer nodes (224 bytes each) and their leaves stays in a processor's cache however rays are ordered.
constexpr std::uint64_t sorting_pays_from_nodes = 1024;

std::size_t default_batch_paths(bool cpu) { return cpu ? cpu_batch_paths : gpu_batch_paths; }

/// Morton bits per axis so that a bin holds a few rays on average.
uint sort_bits_for(std::size_t rays) {
  const double bits = (std::log2(static_cast<double>(std::max<std::size_t>(rays, 1))) - 3 - 2) / 3;
  return static_cast<uint>(std::clamp(static_cast<int>(bits), 0, 6));
}

/// CAPLET_NONE: sorting does not pay.
uint sort_bits_of(const DeviceScene& scene, std::size_t batch_paths) {
  return scene.bvh_nodes() >= sorting_pays_from_nodes ? sort_bits_for(batch_paths) : CAPLET_NONE;
}

std::size_t bins_of(uint sort_bits) { return sort_bits == CAPLET_NONE ? 1 : std::size_t{8} << (3 * sort_bits); }

Window window_of(const ViewRecord& view) {
  return {narrow<int>(view.crop_x), narrow<int>(view.crop_y), narrow<int>(view.crop_width), narrow<int>(view.crop_height)};
}

/// The exponent of the power of two above |x|, within what sums have room for; 0 of what has none.
int exponent_of(double x) {
  return x > 0 && std::isfinite(x) ? std::clamp(std::ilogb(x) + 1, -largest_film_exponent, largest_film_exponent) : 0;
}

/// Of the whole scene and the camera, as seen from the world's origin.
double extent_of(const WorldRecord& world, const CameraRecord& camera) {
  double at = 0;
  for (const int k : {3, 7, 11}) at += std::abs(double{camera.world_from_camera[k]});
  return at + std::abs(double{world.center_x}) + std::abs(double{world.center_y}) + std::abs(double{world.center_z}) +
         double{world.radius};
}

std::size_t chosen_batch_paths(const Device& device, std::size_t wanted, std::size_t most) {
  return std::clamp<std::size_t>(wanted ? wanted : default_batch_paths(device.is_cpu()), 1, std::max<std::size_t>(most, 1));
}

}  // namespace

Film DeviceFilm::read(int first, int rows) const {
  FilmLayout part = layout;
  part.window.y += first;
  part.window.height = rows;
  const std::size_t row_words = static_cast<std::size_t>(part.window.width) * part.words_per_pixel();
  std::vector<std::uint64_t> values(static_cast<std::size_t>(rows) * row_words);
  words.RawBuffer::read(values.data(), static_cast<std::size_t>(first) * row_words * sizeof(ulong),
                        values.size() * sizeof(ulong));
  const bool whole = part.window == layout.window;
  return Film(part, std::move(values), whole ? parts : std::vector<FilmPart>());
}

Renderer::Renderer(DeviceScene& scene, const FlatView& view, const RendererOptions& options)
    : scene_(scene),
      batch_paths_(chosen_batch_paths(scene.device(), options.batch_paths, options.most_paths)),
      sort_bits_(sort_bits_of(scene, batch_paths_)),
      layers_(options.layers),
      paths_(scene.device(), batch_paths_, bins_of(sort_bits_), layers_) {
  reset(view);
}

void Renderer::reset(const FlatView& view) {
  if (const uint sort_bits = sort_bits_of(scene_, batch_paths_); sort_bits != sort_bits_) {
    sort_bits_ = sort_bits;
    paths_.sort.sort_bins = Buffer<uint>(scene_.device(), bins_of(sort_bits_));
  }
  sensor_ = SensorBuffers(scene_.device(), view);
  FilmLayout layout;
  layout.width = narrow<int>(view.view.width);
  layout.height = narrow<int>(view.view.height);
  layout.window = window_of(view.view);
  layout.layers = layers_;
  layout.color_exponent = exponent_of(scene_.light_radiance());
  layout.length_exponent = exponent_of(extent_of(scene_.world(), view.camera));
  const std::size_t pixels = layout.window.pixels(), words = pixels * layout.words_per_pixel();
  if (words != film_.words.size() || film_.words.handle()() == nullptr) {
    film_ = {};  // the old one makes room first
    film_.words = Buffer<ulong>(scene_.device(), words);
  }
  film_.layout = layout;
  film_.parts.clear();
  is_old_ = true;
  std::vector<Stage> stages(render_stages().begin(), render_stages().end());
  if (!scene_.has_camera_stage()) std::erase(stages, Stage::extend_camera);
  scene_.kernels().compile(stages, batch_paths_);
}

// Megabytes: left to the first pass where that goes over all of it.
void Renderer::clear_film() const {
  if (is_old_) film_.words.clear();
  is_old_ = false;
}

const DeviceFilm& Renderer::film() const {
  clear_film();
  return film_;
}

void Renderer::clear_counters() {
  const std::array<uint, counter_count> zeros{};
  paths_.counters.counters.write(zeros);
}

void Renderer::pass(const Window& window, std::uint32_t sample_begin, std::uint32_t sample_count,
                    const std::function<void(std::size_t)>& batch_done) {
  CHECK_EQ_(film_.layout.window.holds(window), true);
  CHECK_LT_(0u, sample_count);
  CHECK_LE_(std::size_t{sample_count}, batch_paths_);
  add_part(film_.parts, {window, sample_begin, sample_count});
  if (window != film_.layout.window) clear_film();
  const bool first_pass = std::exchange(is_old_, false);
  const std::size_t pixels = window.pixels(), per_batch = batch_paths_ / sample_count;
  for (std::size_t first = 0; first < pixels; first += per_batch) {
    const std::size_t count = std::min(per_batch, pixels - first);
    BatchRecord record{};
    record.window_x = narrow<uint>(window.x);
    record.window_y = narrow<uint>(window.y);
    record.window_width = narrow<uint>(window.width);
    record.window_height = narrow<uint>(window.height);
    record.pixel_begin = narrow<uint>(first);
    record.pixel_count = narrow<uint>(count);
    record.sample_begin = sample_begin;
    record.sample_count = sample_count;
    record.path_count = narrow<uint>(count * sample_count);
    record.sort_bits = sort_bits_;
    record.layers = layers_.bits();
    record.layer_floats = narrow<uint>(film_.layout.floats_per_path());
    record.film_words = narrow<uint>(film_.layout.words_per_pixel());
    record.color_exponent = film_.layout.color_exponent;
    record.length_exponent = film_.layout.length_exponent;
    record.first = first_pass ? 1 : 0;
    batch(record);
    if (batch_done) batch_done(first + count);
  }
}

// The algorithm: see kernels/stages/path.cl.
void Renderer::batch(const BatchRecord& record) {
  Kernels& kernels = scene_.kernels();
  Bindings bindings = scene_.bindings();
  sensor_.bind(bindings);
  paths_.bind(bindings);
  const FilmBuffers film{film_.words};
  bindings.film = &film;
  const bool sorts = sort_bits_ != CAPLET_NONE;
  paths_.batch.batch.write({&record, 1});
  clear_counters();
  kernels.run(Stage::generate, bindings, record.path_count);
  rays_.camera += record.path_count;
  std::array<uint, counter_count> counters{};
  Stage extend = scene_.has_camera_stage() ? Stage::extend_camera : Stage::extend;
  for (std::size_t queued = record.path_count; queued > 0;) {
    if (sorts) paths_.sort.sort_bins.clear();
    kernels.run(extend, bindings, queued);
    extend = Stage::extend;
    kernels.run(Stage::shade, bindings, queued);
    paths_.counters.counters.RawBuffer::read(counters.data(), 0, sizeof counters);
    ++beats_;
    const uint next = counters[counter_next], shadow = counters[counter_shadow];
    kernels.run(Stage::connect, bindings, shadow);
    if (!sorts) {
      std::swap(paths_.queues.queue, paths_.queues.queue_next);
    } else if (next > 0) {
      kernels.run(Stage::sort_prefix, bindings, 1);
      kernels.run(Stage::sort_scatter, bindings, next);
    }
    clear_counters();
    rays_.bounce += next;
    rays_.shadow += shadow;
    queued = next;
  }
  kernels.run(Stage::resolve, bindings, record.pixel_count);
  paths_.counters.counters.RawBuffer::read(counters.data(), 0, sizeof counters);
  ++beats_;
  rays_.not_finite += counters[counter_not_finite];
}

std::uint64_t batch_bytes(bool cpu) { return PathBuffers::bytes_per_path(Layers::all()) * default_batch_paths(cpu); }

}  // namespace caplet
