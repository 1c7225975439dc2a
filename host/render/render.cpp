// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "render/render.h"

#include <algorithm>

#include "base/check.h"
#include "base/clock.h"

namespace caplet {

SessionOptions session_options(const RenderOptions& options) {
  CHECK_LT_(0, options.samples_per_pixel);
  return {.sample_begin = options.sample_begin,
          .layers = options.layers,
          .batch_paths = options.batch_paths,
          .most_samples = static_cast<std::uint32_t>(options.samples_per_pixel),
          .time_stages = options.time_stages,
          .patience = options.patience};
}

RenderResult render(const FlatScene& scene, const FlatView& view, std::span<const Device> devices,
                    const RenderOptions& options,
                    const std::function<void(const Progress&)>& progress) {
  Session session(scene, view, {devices.begin(), devices.end()}, session_options(options));
  return render(session, devices, options, progress);
}

RenderResult render(Session& session, std::span<const Device> devices, const RenderOptions& options,
                    const std::function<void(const Progress&)>& progress) {
  const auto total = static_cast<std::uint32_t>(options.samples_per_pixel);
  RenderResult result;
  result.compile_seconds = session.compile_seconds();
  result.stage_compile_seconds = session.compile_seconds_by_stage();
  const Clock::time_point start = Clock::now();
  if (progress) progress({0, 0, 0});
  std::uint32_t done = session.samples();
  const auto pass = [&](std::uint32_t samples) {
    std::optional<double> time_left = options.time_limit;
    if (time_left) *time_left = std::max(0.0, *time_left - seconds_since(start));
    const std::uint32_t more = session.render(
        samples,
        [&](const SessionProgress& now) {
          if (now.samples_done > 0 && result.first_pass_seconds == 0)
            result.first_pass_seconds = seconds_since(start);
          if (options.cancelled && options.cancelled()) session.cancel();
          if (progress)
            progress({(done + now.fraction * samples) / total, narrow<int>(done + now.samples_done),
                      now.samples_per_second});
        },
        time_left);
    done += more;
    // A pass of one batch hears of it when it is complete.
    return more == samples && !(options.cancelled && options.cancelled());
  };
  if (!options.looks.empty()) {
    const double shortest = std::ranges::min(options.looks, {}, &Look::seconds).seconds;
    std::vector<Clock::time_point> last(options.looks.size(), start);
    // A pass has as many samples as take up to half the time between two looks.
    for (std::uint32_t samples = 1; done < total;) {
      const Clock::time_point begin = Clock::now();
      if (!pass(std::min(samples, total - done)) ||
          (options.time_limit && seconds_since(start) >= *options.time_limit))
        break;
      const double seconds = seconds_since(begin);
      if (seconds < shortest / 4) samples *= 2;
      if (seconds > shortest / 2) samples = std::max<std::uint32_t>(1, samples / 2);
      if (done >= total) break;
      std::optional<Film> film;
      for (std::size_t i = 0; i < last.size(); ++i) {
        if (seconds_since(last[i]) < options.looks[i].seconds) continue;
        if (!film) film = session.film();
        options.looks[i].show(*film);
        last[i] = Clock::now();
      }
    }
  } else if (done < total) {
    pass(total - done);
  }
  result.interrupted = options.cancelled && options.cancelled();
  if (options.film_on_device) result.device_film = session.film_on_device();
  if (!result.device_film) result.film = session.film();
  result.render_seconds = seconds_since(start);
  result.samples_per_pixel = narrow<int>(done);
  const RayCounts rays = session.rays();
  result.camera_rays = rays.camera;
  result.bounce_rays = rays.bounce;
  result.shadow_rays = rays.shadow;
  if (options.time_stages) result.stage_seconds = session.seconds_by_stage();
  for (const Device& device : devices) result.peak_device_bytes += device.bytes_peak();
  result.devices = session.work();
  return result;
}

RenderResult render(const FlatScene& scene, const FlatView& view, const Device& device,
                    const RenderOptions& options,
                    const std::function<void(const Progress&)>& progress) {
  return render(scene, view, std::span(&device, 1), options, progress);
}

}  // namespace caplet
