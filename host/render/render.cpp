// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "render/render.h"

#include <algorithm>
#include <chrono>

#include "base/check.h"
#include "base/log.h"
#include "render/renderer.h"

namespace caplet {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

/// Samples a pixel in the next pass: what fills a batch over all pixels, so that small images are not rendered in slivers.
uint samples_in_pass(const Renderer& renderer, std::size_t pixels, int left) {
  const std::size_t fill = std::max<std::size_t>(1, renderer.batch_paths() / pixels);
  return narrow<uint>(std::min<std::size_t>({fill, static_cast<std::size_t>(left), renderer.batch_paths()}));
}

}  // namespace

RenderResult render(const FlatScene& scene, const FlatView& view, const Device& device, const RenderOptions& options,
                    const std::function<void(const Progress&)>& progress) {
  CHECK_LT_(0, options.samples_per_pixel);
  const int total = options.samples_per_pixel;
  const std::size_t pixels = std::size_t{view.view.crop_width} * view.view.crop_height;
  DeviceScene on_device(device, scene);
  Renderer renderer(
      on_device, view,
      {.layers = options.layers, .batch_paths = options.batch_paths, .most_paths = pixels * static_cast<std::size_t>(total)});
  Kernels& kernels = on_device.kernels();
  kernels.time_stages(options.time_stages);

  RenderResult result;
  result.compile_seconds = kernels.compile_seconds();
  result.stage_compile_seconds = kernels.compile_seconds_by_stage();
  const Clock::time_point start = Clock::now();
  if (progress) progress({0, 0, 0});
  int done = 0;
  while (done < total) {
    const uint count = samples_in_pass(renderer, pixels, total - done);
    renderer.pass(renderer.layout().window, static_cast<uint>(done), count, [&](std::size_t pixels_done) {
      if (!progress) return;
      const double samples = done + static_cast<double>(count) * static_cast<double>(pixels_done) / static_cast<double>(pixels);
      progress({samples / total, done, samples * static_cast<double>(pixels) / std::max(1e-9, seconds_since(start))});
    });
    done += static_cast<int>(count);
    if (result.first_pass_seconds == 0) result.first_pass_seconds = seconds_since(start);
    result.interrupted = options.cancelled && options.cancelled();
    if (result.interrupted || (options.time_limit && seconds_since(start) >= *options.time_limit)) break;
  }
  if (options.film_on_device)
    result.device_film = renderer.film();
  else
    result.film = renderer.film().read();
  result.render_seconds = seconds_since(start);
  result.samples_per_pixel = done;
  result.camera_rays = renderer.rays().camera;
  result.bounce_rays = renderer.rays().bounce;
  result.shadow_rays = renderer.rays().shadow;
  if (options.time_stages) result.stage_seconds = kernels.seconds_by_stage();
  result.peak_device_bytes = device.bytes_peak();
  if (renderer.rays().not_finite > 0) log::warn("{} samples were not finite and count as black", renderer.rays().not_finite);
  return result;
}

}  // namespace caplet
