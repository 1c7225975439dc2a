// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "render/render.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "base/check.h"
#include "base/interrupt.h"
#include "base/log.h"
#include "render/stages.h"

namespace caplet {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

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

class Wavefront {
 public:
  Wavefront(const FlatScene& scene, const Device& device, const RenderOptions& options) : params_(scene.params) {
    pixels_ = std::size_t{params_.crop_width} * params_.crop_height;
    const std::size_t wanted = options.batch_paths ? options.batch_paths : default_batch_paths(device.is_cpu());
    const std::size_t all = pixels_ * static_cast<std::size_t>(options.samples_per_pixel);
    batch_paths_ = std::clamp<std::size_t>(wanted, 1, std::max<std::size_t>(all, 1));
    StateSize size;
    size.paths = batch_paths_;
    size.pixels = pixels_;
    sorts_ = scene.bvh_nodes >= sorting_pays_from_nodes;
    params_.sort_bits = sorts_ ? sort_bits_for(batch_paths_) : CAPLET_NONE;
    size.sort_bins = bins();
    stages_.emplace(device, scene, size, stage_options(scene, device));
    stages_->compile(render_stages(), batch_paths_);
  }

  /// Samples [begin, begin + count) of every pixel.
  void pass(uint begin, uint count, const std::function<void(std::size_t)>& batch_done) {
    const std::size_t per_batch = std::max<std::size_t>(1, batch_paths_ / count);
    for (std::size_t first = 0; first < pixels_; first += per_batch) {
      batch(first, std::min(per_batch, pixels_ - first), begin, count);
      batch_done(std::min(first + per_batch, pixels_));
    }
  }

  std::size_t batch_paths() const { return batch_paths_; }
  std::size_t pixels() const { return pixels_; }
  Stages& stages() { return *stages_; }
  std::uint64_t camera_rays = 0, bounce_rays = 0, shadow_rays = 0, not_finite = 0;

 private:
  std::size_t bins() const { return sorts_ ? std::size_t{8} << (3 * params_.sort_bits) : 1; }

  // The algorithm: see kernels/stages/path.cl.
  void batch(std::size_t pixel_begin, std::size_t pixel_count, uint sample_begin, uint sample_count) {
    Stages& stages = *stages_;
    params_.pixel_begin = narrow<uint>(pixel_begin);
    params_.pixel_count = narrow<uint>(pixel_count);
    params_.sample_begin = sample_begin;
    params_.sample_count = sample_count;
    params_.path_count = narrow<uint>(pixel_count * sample_count);
    stages.set_params(params_);
    stages.set_counters({params_.path_count, 0, 0, 0});
    stages.run(Stage::generate, params_.path_count);
    camera_rays += params_.path_count;
    for (std::size_t queued = params_.path_count; queued > 0;) {
      if (sorts_) stages.clear_sort_bins(bins());
      stages.run(Stage::extend, queued);
      stages.run(Stage::shade, queued);
      const auto [unused, next, shadow, bad] = stages.counters();
      stages.run(Stage::connect, shadow);
      if (!sorts_) {
        stages.swap_queues();
      } else if (next > 0) {
        stages.run(Stage::sort_prefix, 1);
        stages.run(Stage::sort_scatter, next);
      }
      stages.set_counters({next, 0, 0, 0});
      bounce_rays += next;
      shadow_rays += shadow;
      queued = next;
    }
    stages.run(Stage::resolve, pixel_count);
    not_finite += stages.counters()[3];
  }

  ParamsRecord params_;
  std::size_t pixels_ = 0, batch_paths_ = 0;
  bool sorts_ = false;
  std::optional<Stages> stages_;
};

/// Samples a pixel in the next pass: what fills a batch over all pixels, so that small images are not rendered in slivers.
uint samples_in_pass(const Wavefront& wavefront, int left) {
  const std::size_t fill = std::max<std::size_t>(1, wavefront.batch_paths() / wavefront.pixels());
  return narrow<uint>(std::min<std::size_t>({fill, static_cast<std::size_t>(left), wavefront.batch_paths()}));
}

}  // namespace

RenderResult render(const FlatScene& scene, const Device& device, const RenderOptions& options,
                    const std::function<void(const Progress&)>& progress) {
  CHECK_LT_(0, options.samples_per_pixel);
  Wavefront wavefront(scene, device, options);
  RenderResult result;
  result.compile_seconds = wavefront.stages().compile_seconds();
  result.stage_compile_seconds = wavefront.stages().compile_seconds_by_stage();

  wavefront.stages().time_stages(options.time_stages);

  const Clock::time_point start = Clock::now();
  const int total = options.samples_per_pixel;
  if (progress) progress({0, 0, 0});
  int done = 0;
  while (done < total) {
    const uint count = samples_in_pass(wavefront, total - done);
    wavefront.pass(static_cast<uint>(done), count, [&](std::size_t pixels_done) {
      const double samples =
          done + static_cast<double>(count) * static_cast<double>(pixels_done) / static_cast<double>(wavefront.pixels());
      if (progress)
        progress(
            {samples / total, done, samples * static_cast<double>(wavefront.pixels()) / std::max(1e-9, seconds_since(start))});
    });
    done += static_cast<int>(count);
    if (result.first_pass_seconds == 0) result.first_pass_seconds = seconds_since(start);
    result.interrupted = interrupt_requested();
    if (result.interrupted || (options.time_limit && seconds_since(start) >= *options.time_limit)) break;
  }
  if (options.film_on_device)
    result.device_film = wavefront.stages().film();
  else
    result.film = wavefront.stages().film().read();
  result.render_seconds = seconds_since(start);
  result.samples_per_pixel = done;
  result.camera_rays = wavefront.camera_rays;
  result.bounce_rays = wavefront.bounce_rays;
  result.shadow_rays = wavefront.shadow_rays;
  if (options.time_stages) result.stage_seconds = wavefront.stages().seconds_by_stage();
  result.peak_device_bytes = device.bytes_peak();
  if (wavefront.not_finite > 0) log::warn("{} samples were not finite and count as black", wavefront.not_finite);
  return result;
}

std::uint64_t batch_bytes(bool cpu) {
  std::uint64_t path = 0;
#define PATH_STATE(name, type, count) path += sizeof(type) * (count);
#include "shared/path_state.def"
#undef PATH_STATE
  return path * default_batch_paths(cpu);
}

}  // namespace caplet
