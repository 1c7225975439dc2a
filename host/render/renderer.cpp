// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "render/renderer.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>

#include "base/check.h"
#include "base/clock.h"
#include "render/detail/array_parts.h"
#include "render/detail/launch_policy.h"

namespace caplet {

namespace {

// A tree of fewer nodes (224 bytes each) and their leaves stays in a CPU's cache however rays are
// ordered: sorting gains a third on a million capsules, and loses a tenth on 36 triangles.
constexpr std::uint64_t sorting_pays_from_nodes = 1024;

/// Returns Morton bits per axis so that a bin holds a few rays on average.
uint sort_bits_for(std::size_t rays) {
  const double bits = (std::log2(static_cast<double>(std::max<std::size_t>(rays, 1))) - 3 - 2) / 3;
  return static_cast<uint>(std::clamp(static_cast<int>(bits), 0, 6));
}

/// Returns CAPLET_NONE if sorting does not pay.
uint sort_bits_of(const DeviceScene& scene, std::size_t batch_paths) {
  return scene.bvh_nodes() >= sorting_pays_from_nodes ? sort_bits_for(batch_paths) : CAPLET_NONE;
}

std::size_t bins_of(uint sort_bits) {
  return sort_bits == CAPLET_NONE ? 1 : std::size_t{8} << (3 * sort_bits);
}

Window window_of(const ViewRecord& view) {
  return {narrow<int>(view.crop_x), narrow<int>(view.crop_y), narrow<int>(view.crop_width),
          narrow<int>(view.crop_height)};
}

/// Returns the exponent of the power of two above |x|, within the range that sums have room for; 0
/// if there is none.
int exponent_of(double x) {
  return x > 0 && std::isfinite(x)
             ? std::clamp(std::ilogb(x) + 1, -largest_film_exponent, largest_film_exponent)
             : 0;
}

/// Returns the extent of the whole scene and the camera, as seen from the world's origin.
double extent_of(const WorldRecord& world, const FlatView& view) {
  double at = 0;
  for (const int k : {3, 7, 11}) at += std::abs(double{view.camera.world_from_camera[k]});
  // The coefficients of a cubic are together at least its values.
  const std::size_t cubics = 2 * std::size_t{view.camera.motion_segments};
  for (std::size_t i = cubics;
       i < cubics + CAPLET_MOTION_FLOATS * std::size_t{view.camera.motion_segments};
       i += CAPLET_MOTION_FLOATS) {
    double there = 0;
    for (std::size_t k = 3; k < CAPLET_MOTION_FLOATS; k += 4)
      there += std::abs(double{view.camera_table[i + k]});
    at = std::max(at, there);
  }
  return at + std::abs(double{world.center_x}) + std::abs(double{world.center_y}) +
         std::abs(double{world.center_z}) + double{world.radius};
}

PathNeeds needs_of(const DeviceScene& scene, Layers layers) {
  return {layers, scene.has_textures(), scene.has_light_tree(), scene.has_media(), scene.moves()};
}

std::size_t chosen_batch_paths(const DeviceScene& scene, const FlatView& view,
                               const RendererOptions& options) {
  const Device& device = scene.device();
  const LaunchPolicy policy = launch_policy_of(device);
  const std::size_t wanted =
      std::clamp<std::size_t>(options.batch_paths ? options.batch_paths : policy.batch_paths, 1,
                              std::max<std::size_t>(options.most_paths, 1));
  FilmLayout layout;
  layout.layers = options.layers;
  const std::uint64_t film = std::uint64_t{view.view.crop_width} * view.view.crop_height *
                             layout.words_per_pixel() * sizeof(ulong);
  const std::uint64_t bins =
      sort_places(bins_of(sort_bits_of(scene, wanted)), policy.sort_fan) * sizeof(uint);
  // Drivers keep some memory for themselves, for example for private memory of kernels.
  const std::uint64_t all = device.info().global_bytes / 8 * 7,
                      taken = device.bytes_allocated() + film + bins;
  const PathNeeds needs = needs_of(scene, options.layers);
  return fitting_batch(wanted, PathBuffers::bytes_per_path(needs),
                       PathBuffers::largest_bytes_per_path(needs), all - std::min(all, taken),
                       most_buffer_bytes(device));
}

/// Allocates buffers for `paths` paths, or for fewer where the device turns out to have less memory
/// than it says.
PathBuffers path_buffers(const DeviceScene& scene, std::size_t& paths, Layers layers) {
  const auto made = [&] {
    const std::size_t bins = bins_of(sort_bits_of(scene, paths));
    return PathBuffers(scene.device(), paths,
                       sort_places(bins, launch_policy_of(scene.device()).sort_fan),
                       needs_of(scene, layers));
  };
  while (paths > least_batch_paths) try {
      return made();
    } catch (const DriverError&) {
      paths = (paths + 1) / 2;
    }
  return made();
}

}  // namespace

Film DeviceFilm::read(int first, int rows) const {
  FilmLayout part = layout;
  part.window.y += first;
  part.window.height = rows;
  const std::size_t row_words =
      static_cast<std::size_t>(part.window.width) * part.words_per_pixel();
  std::vector<std::uint64_t> values(static_cast<std::size_t>(rows) * row_words);
  for (int row = first; row < first + rows;) {
    const int buffer = row / rows_of_buffer,
              end = std::min(first + rows, (buffer + 1) * rows_of_buffer);
    const auto at = [&](int r, int from) { return static_cast<std::size_t>(r - from) * row_words; };
    words[static_cast<std::size_t>(buffer)].RawBuffer::read(
        values.data() + at(row, first), at(row, buffer * rows_of_buffer) * sizeof(ulong),
        at(end, row) * sizeof(ulong));
    row = end;
  }
  const bool whole = part.window == layout.window;
  return Film(part, std::move(values), whole ? parts : std::vector<FilmPart>());
}

Renderer::Renderer(DeviceScene& scene, const FlatView& view, const RendererOptions& options)
    : scene_(scene),
      batch_paths_(chosen_batch_paths(scene, view, options)),
      layers_(options.layers),
      paths_(path_buffers(scene, batch_paths_, layers_)),
      sort_bits_(sort_bits_of(scene, batch_paths_)),
      chunk_(launch_policy_of(scene.device()).first_chunk) {
  reset(view);
}

void Renderer::reset(const FlatView& view) {
  scene_.prepare_for(view);
  if (const uint sort_bits = sort_bits_of(scene_, batch_paths_); sort_bits != sort_bits_) {
    sort_bits_ = sort_bits;
    const LaunchPolicy policy = launch_policy_of(scene_.device());
    paths_.sort.sort_bins =
        Buffer<uint>(scene_.device(), sort_places(bins_of(sort_bits_), policy.sort_fan));
  }
  paths_.provide(scene_.device(), batch_paths_, needs_of(scene_, layers_));
  FlatView sampled = view;
  if (layers_.has(Layer::variance)) sampled.view.strategy |= CAPLET_STRATEGY_REPLICATES;
  sensor_ = SensorBuffers(scene_.device(), sampled);
  origins_differ_ = view.camera.origins != 0;
  FilmLayout layout;
  layout.width = narrow<int>(view.view.width);
  layout.height = narrow<int>(view.view.height);
  layout.window = window_of(view.view);
  layout.layers = layers_;
  layout.color_exponent = exponent_of(scene_.light_radiance());
  layout.length_exponent = exponent_of(extent_of(scene_.world(), view));
  provide_film(layout);
  film_.layout = layout;
  film_.parts.clear();
  is_old_ = true;
  has_clip_ = has_clip(view);
  const StageNeeds needs = scene_.needs(has_clip_);
  stages_ = {first_needed({Stage::extend_alpha, Stage::extend_camera, Stage::extend}, needs),
             first_needed({Stage::extend_alpha, Stage::extend}, needs),
             first_needed({Stage::shade, Stage::shade_media}, needs),
             first_needed({Stage::connect, Stage::connect_alpha, Stage::connect_media}, needs)};
  scene_.kernels().compile(render_stages(needs));
}

void Renderer::provide_film(const FilmLayout& layout) {
  const std::size_t row_words =
      static_cast<std::size_t>(layout.window.width) * layout.words_per_pixel();
  const std::uint64_t rows = most_buffer_bytes(scene_.device()) / (row_words * sizeof(ulong));
  const int height = layout.window.height;
  int each = static_cast<int>(std::clamp<std::uint64_t>(rows, 1, std::uint64_t(height)));
  if (each < height && each >= 8) each = each / 8 * 8;  // lists of pixels go tile by tile
  std::vector<std::size_t> sizes;                       // of the buffers
  for (int row = 0; row < height; row += each)
    sizes.push_back(static_cast<std::size_t>(std::min(each, height - row)) * row_words);
  if (!std::ranges::equal(sizes, film_.words, {}, {}, &Buffer<ulong>::size)) {
    film_ = {};  // the old one makes room first
    for (const std::size_t size : sizes) film_.words.emplace_back(scene_.device(), size);
  }
  film_.rows_of_buffer = each;
}

// Clearing takes megabytes: it is left to the first pass if that covers the whole film.
void Renderer::clear_film() const {
  if (is_old_)
    for (Buffer<ulong>& part : film_.words) part.clear();
  is_old_ = false;
}

const DeviceFilm& Renderer::film() const {
  clear_film();
  return film_;
}

void Renderer::pass(const Window& window, std::uint32_t sample_begin, std::uint32_t sample_count,
                    const std::function<void(std::size_t)>& batch_done) {
  CHECK_EQ_(film_.layout.window.holds(window), true);
  CHECK_LT_(0u, sample_count);
  CHECK_LE_(std::size_t{sample_count}, batch_paths_);
  add_part(film_.parts, {window, sample_begin, sample_count});
  if (window != film_.layout.window) clear_film();
  const bool first_pass = std::exchange(is_old_, false);
  const std::size_t per_batch = batch_paths_ / sample_count;
  std::size_t done = 0;
  // The part of the window in each of the film's buffers, after the other.
  for (Window part = window; part.y < window.y + window.height; part.y += part.height) {
    const std::size_t buffer = film_buffer(part.y);
    const int end = film_.layout.window.y + (static_cast<int>(buffer) + 1) * film_.rows_of_buffer;
    part.height = std::min(window.y + window.height, end) - part.y;
    const std::size_t pixels = part.pixels();
    for (std::size_t first = 0; first < pixels; first += per_batch) {
      const std::size_t count = std::min(per_batch, pixels - first);
      BatchRecord record = batch_of(count, sample_count);
      record.window_x = narrow<uint>(part.x);
      record.window_y = narrow<uint>(part.y);
      record.window_width = narrow<uint>(part.width);
      record.window_height = narrow<uint>(part.height);
      record.pixel_begin = narrow<uint>(first);
      record.sample_begin = sample_begin;
      record.first = first_pass ? 1 : 0;
      batch(record, buffer);
      if (batch_done) batch_done(done + first + count);
    }
    done += pixels;
  }
}

void Renderer::pass(std::span<const PixelRecord> pixels, std::uint32_t sample_count,
                    const std::function<void(std::size_t)>& batch_done) {
  CHECK_LT_(0u, sample_count);
  clear_film();
  const auto most_samples =
      static_cast<std::uint32_t>(std::min<std::size_t>(sample_count, batch_paths_));
  const std::size_t per_batch = std::min(batch_paths_ / most_samples, pixels.size());
  // The list is behind the batch's record.
  Buffer<BatchRecord>& listed = paths_.batch.batch;
  const std::size_t room =
      1 + (per_batch * sizeof(PixelRecord) + sizeof(BatchRecord) - 1) / sizeof(BatchRecord);
  if (listed.size() < room) listed = Buffer<BatchRecord>(scene_.device(), room);
  const auto buffer_of = [this](const PixelRecord& one) { return film_buffer(narrow<int>(one.y)); };
  for (std::size_t first = 0; first < pixels.size();) {
    const std::size_t buffer = buffer_of(pixels[first]);
    const std::span<const PixelRecord> next =
        pixels.subspan(first, std::min(per_batch, pixels.size() - first));
    std::vector<PixelRecord> records;
    for (const PixelRecord& one : next) {
      if (buffer_of(one) != buffer) break;
      records.push_back(one);
    }
    first += records.size();
    for (std::uint32_t done = 0; done < sample_count;) {
      const std::uint32_t samples = std::min(most_samples, sample_count - done);
      listed.RawBuffer::write(records.data(), sizeof(BatchRecord),
                              records.size() * sizeof(PixelRecord));
      BatchRecord record = batch_of(records.size(), samples);
      record.listed = 1;
      batch(record, buffer);
      for (PixelRecord& each : records) each.sample_begin += samples;
      done += samples;
    }
    if (batch_done) batch_done(first);
  }
}

BatchRecord Renderer::batch_of(std::size_t count, std::uint32_t sample_count) const {
  const LaunchPolicy policy = launch_policy_of(scene_.device());
  BatchRecord record{};
  record.pixel_count = narrow<uint>(count);
  record.sample_count = sample_count;
  record.path_count = narrow<uint>(count * sample_count);
  record.sort_bits = sort_bits_;
  record.layers = layers_.bits();
  record.layer_floats = narrow<uint>(film_.layout.floats_per_path());
  record.film_words = narrow<uint>(film_.layout.words_per_pixel());
  record.color_exponent = film_.layout.color_exponent;
  record.length_exponent = film_.layout.length_exponent;
  record.by_sample = policy.by_sample ? 1 : 0;
  record.layers_apart = policy.layers_apart ? 1 : 0;
  record.sort_fan = policy.sort_fan;
  return record;
}

// kernels/stages/path.cl describes the algorithm.
void Renderer::batch(BatchRecord record, std::size_t film_buffer) {
  Kernels& kernels = scene_.kernels();
  const LaunchPolicy policy = launch_policy_of(scene_.device());
  Bindings bindings = scene_.bindings();
  sensor_.bind(bindings);
  paths_.bind(bindings);
  record.film_begin = narrow<uint>(film_buffer * static_cast<std::size_t>(film_.rows_of_buffer) *
                                   static_cast<std::size_t>(film_.layout.window.width));
  const FilmBuffers film{film_.words[film_buffer]};
  bindings.film = &film;
  paths_.batch.batch.write({&record, 1});
  std::array<uint, counter_count> counters{};
  counters[counter_queued] = record.path_count;
  paths_.counters.counters.write(counters);
  kernels.set_chunk(chunk_);
  kernels.run(Stage::generate, bindings, record.path_count);
  if (scene_.has_media())
    kernels.run(Stage::camera_media, bindings, origins_differ_ ? record.path_count : 1);
  rays_.camera += record.path_count;
  policy.counts_on_device ? rounds_on_device(bindings, record.path_count)
                          : rounds_by_host(bindings, record.path_count);
  const auto layers = static_cast<std::size_t>(std::popcount(layers_.bits()));
  kernels.run(Stage::resolve, bindings, record.pixel_count * (policy.layers_apart ? layers : 1));
  paths_.counters.counters.RawBuffer::read(counters.data(), 0, sizeof counters);
  ++beats_;
  rays_.not_finite += counters[counter_not_finite];
}

void Renderer::trace_and_shade(Bindings& bindings, Stage extend, std::size_t paths,
                               cl_uint counter) {
  Kernels& kernels = scene_.kernels();
  if (sort_bits_ != CAPLET_NONE) paths_.sort.sort_bins.clear();
  kernels.run(extend, bindings, paths, 0, counter);
  if (has_clip_)
    kernels.run(scene_.has_media() ? Stage::clip_media : Stage::clip, bindings, paths, 0, counter);
  if (scene_.has_media()) {
    kernels.run(Stage::recount_media, bindings, paths, 0, counter);
    kernels.run(Stage::sample_distance, bindings, paths, 0, counter);
  }
  kernels.run(stages_.shade, bindings, paths, 0, counter);
}

void Renderer::connect_and_sort(Bindings& bindings, Launched shadows, Launched next) {
  scene_.kernels().run(stages_.connect, bindings, shadows.count, 0, shadows.counter);
  if (sort_bits_ == CAPLET_NONE)
    std::swap(paths_.queues.queue, paths_.queues.queue_next);
  else if (next.count > 0)
    sort(bindings, next);
}

void Renderer::rounds_by_host(Bindings& bindings, std::size_t paths) {
  std::array<uint, counter_count> counters{};
  Stage extend = stages_.extend_camera;
  while (paths > 0) {
    trace_and_shade(bindings, std::exchange(extend, stages_.extend), paths, CAPLET_NONE);
    paths_.counters.counters.RawBuffer::read(counters.data(), 0, sizeof counters);
    ++beats_;
    const uint next = counters[counter_next], shadow = counters[counter_shadow];
    connect_and_sort(bindings, {shadow}, {next});
    counters = {};
    paths_.counters.counters.write(counters);
    rays_.bounce += next;
    rays_.shadow += shadow;
    paths = next;
  }
}

void Renderer::rounds_on_device(Bindings& bindings, std::size_t paths) {
  std::array<uint, counter_count> counters{};
  uint bounces = 0, shadows = 0;
  Stage extend = stages_.extend_camera;
  const int rounds = launch_policy_of(scene_.device()).rounds_unasked;
  while (paths > 0) {
    const Clock::time_point start = Clock::now();
    for (int round = 0; round < rounds; ++round) {
      trace_and_shade(bindings, std::exchange(extend, stages_.extend), paths, counter_queued);
      connect_and_sort(bindings, {paths, counter_shadow}, {paths, counter_next});
      scene_.kernels().run(Stage::advance, bindings, 1);
    }
    paths_.counters.counters.RawBuffer::read(counters.data(), 0, sizeof counters);
    ++beats_;
    chunk_ = next_chunk(chunk_, paths, seconds_since(start));
    scene_.kernels().set_chunk(chunk_);
    rays_.bounce += counters[counter_bounces] - std::exchange(bounces, counters[counter_bounces]);
    rays_.shadow += counters[counter_shadows] - std::exchange(shadows, counters[counter_shadows]);
    paths = counters[counter_queued];
  }
}

/// Sorts queue_next into queue.
void Renderer::sort(const Bindings& bindings, Launched paths) {
  Kernels& kernels = scene_.kernels();
  const std::vector<SortLevel> levels =
      sort_levels(bins_of(sort_bits_), launch_policy_of(scene_.device()).sort_fan);
  for (std::size_t i = 0; i + 1 < levels.size(); ++i)
    kernels.run(Stage::sort_sums, bindings, levels[i].count, levels[i].first);
  for (std::size_t i = levels.size(); i-- > 0;)
    kernels.run(Stage::sort_prefix, bindings, levels[i].count, levels[i].first);
  kernels.run(Stage::sort_scatter, bindings, paths.count, 0, paths.counter);
}

std::uint64_t least_batch_bytes() {
  return PathBuffers::bytes_per_path({Layers::all(), true, true, true}) * least_batch_paths;
}

}  // namespace caplet
