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

std::size_t bins_of(uint sort_bits) { return sort_bits == CAPLET_NONE ? 1 : std::size_t{8} << (3 * sort_bits); }

Window window_of(const ViewRecord& view) {
  return {narrow<int>(view.crop_x), narrow<int>(view.crop_y), narrow<int>(view.crop_width), narrow<int>(view.crop_height)};
}

std::size_t pixels_of(const Window& window) {
  return static_cast<std::size_t>(window.width) * static_cast<std::size_t>(window.height);
}

std::size_t chosen_batch_paths(const Device& device, std::size_t wanted, std::size_t most) {
  return std::clamp<std::size_t>(wanted ? wanted : default_batch_paths(device.is_cpu()), 1, std::max<std::size_t>(most, 1));
}

}  // namespace

Renderer::Renderer(DeviceScene& scene, const FlatView& view, std::size_t batch_paths, std::size_t most_paths)
    : scene_(scene),
      batch_paths_(chosen_batch_paths(scene.device(), batch_paths, most_paths)),
      sort_bits_(scene.bvh_nodes() >= sorting_pays_from_nodes ? sort_bits_for(batch_paths_) : CAPLET_NONE),
      paths_(scene.device(), batch_paths_, bins_of(sort_bits_)) {
  reset(view);
  scene.kernels().compile(render_stages(), batch_paths_);
}

void Renderer::reset(const FlatView& view) {
  const Window window = window_of(view.view);
  sensor_ = SensorBuffers(scene_.device(), view);
  if (pixels_of(window) != film_.film.size()) {
    film_ = {};  // the old one makes room first
    film_.film = Buffer<FilmRecord>(scene_.device(), pixels_of(window));
  }
  film_window_ = window;
  clear_film();
}

void Renderer::clear_film() {
  // In pieces: a film is the largest thing there is.
  const std::size_t pixels = film_.film.size();
  const std::vector<FilmRecord> empty(std::min<std::size_t>(pixels, 1 << 16), FilmRecord{});
  for (std::size_t first = 0; first < pixels; first += empty.size())
    film_.film.RawBuffer::write(empty.data(), first * sizeof(FilmRecord),
                                std::min(empty.size(), pixels - first) * sizeof(FilmRecord));
}

void Renderer::clear_counters() {
  const std::array<uint, counter_count> zeros{};
  paths_.counters.counters.write(zeros);
}

void Renderer::pass(const Window& window, std::uint32_t sample_begin, std::uint32_t sample_count,
                    const std::function<void(std::size_t)>& batch_done) {
  CHECK_LE_(film_window_.x, window.x);
  CHECK_LE_(film_window_.y, window.y);
  CHECK_LE_(window.x + window.width, film_window_.x + film_window_.width);
  CHECK_LE_(window.y + window.height, film_window_.y + film_window_.height);
  CHECK_LT_(0u, sample_count);
  CHECK_LE_(std::size_t{sample_count}, batch_paths_);
  const std::size_t pixels = pixels_of(window), per_batch = batch_paths_ / sample_count;
  for (std::size_t first = 0; first < pixels; first += per_batch) {
    const std::size_t count = std::min(per_batch, pixels - first);
    BatchRecord record{};
    record.window_x = narrow<uint>(window.x);
    record.window_y = narrow<uint>(window.y);
    record.window_width = narrow<uint>(window.width);
    record.pixel_begin = narrow<uint>(first);
    record.pixel_count = narrow<uint>(count);
    record.sample_begin = sample_begin;
    record.sample_count = sample_count;
    record.path_count = narrow<uint>(count * sample_count);
    record.sort_bits = sort_bits_;
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
  bindings.film = &film_;
  const bool sorts = sort_bits_ != CAPLET_NONE;
  paths_.batch.batch.write({&record, 1});
  clear_counters();
  kernels.run(Stage::generate, bindings, record.path_count);
  rays_.camera += record.path_count;
  std::array<uint, counter_count> counters{};
  for (std::size_t queued = record.path_count; queued > 0;) {
    if (sorts)
      scene_.device().queue().enqueueFillBuffer(paths_.sort.sort_bins.handle(), cl_uint{0}, 0, paths_.sort.sort_bins.bytes());
    kernels.run(Stage::extend, bindings, queued);
    kernels.run(Stage::shade, bindings, queued);
    paths_.counters.counters.RawBuffer::read(counters.data(), 0, sizeof counters);
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
  rays_.not_finite += counters[counter_not_finite];
}

std::uint64_t batch_bytes(bool cpu) { return PathBuffers::bytes_per_path() * default_batch_paths(cpu); }

}  // namespace caplet
