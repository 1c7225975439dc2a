// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "render/render.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/check.h"
#include "base/clock.h"
#include "base/error.h"

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

namespace {

/// Course is one render of a session.
class Course {
 public:
  Course(Session& session, const RenderOptions& options,
         const std::function<void(const Progress&)>& progress)
      : session_(session),
        options_(options),
        progress_(progress),
        looked_(options.looks.size(), start_) {
    for (const Look& look : options.looks) shortest_ = std::min(shortest_, look.seconds);
  }

  /// Renders until every pixel has `total` samples, or until it is stopped; returns how many it
  /// has.
  std::uint32_t to_samples(std::uint32_t total) {
    std::uint32_t done = session_.samples();
    // A pass has as many samples as take up to half the time between two looks.
    for (std::uint32_t samples = options_.looks.empty() ? total : 1; done < total;) {
      const Clock::time_point begin = Clock::now();
      const bool is_owed = done < std::min(total, options_.least_samples);
      const std::uint32_t next =
          std::min(samples, (is_owed ? std::min(total, options_.least_samples) : total) - done);
      const std::uint32_t more = session_.render(
          next,
          [&](const SessionProgress& now) {
            heard(now);
            if (progress_) {
              Progress told{(done + now.fraction * next) / total,
                            narrow<int>(done + now.samples_done),
                            now.samples_per_second,
                            {}};
              if (options_.noise) told.fraction = 0;  // how much will follow is not known yet
              progress_(told);
            }
          },
          is_owed ? std::nullopt : time_left());
      done += more;
      if (more < next || stopped(done)) break;
      const double seconds = seconds_since(begin);
      if (seconds < shortest_ / 4) samples *= 2;
      if (seconds > shortest_ / 2) samples = std::max<std::uint32_t>(1, samples / 2);
      if (done < total) look();
    }
    return done;
  }

  /// Renders until each pixel has what its target wants, or until it is stopped; returns the film.
  Film to_noise(const NoiseTarget& target, NoiseReached& reached) {
    const bool begun =
        session_.samples() >= target.least || to_samples(target.least) == target.least;
    SampledPixels sampled(session_.layout());
    const auto pixels = static_cast<double>(sampled.size());
    while (true) {
      const std::vector<FilmPart> parts = session_.parts();
      if (parts.size() > 1)
        throw InputError("the film has gaps between its samples: it has no next ones");
      session_.look_at_film([&](const Film& rows) { sampled.look_at(rows); });
      SamplePlan plan =
          plan_samples(sampled, parts.empty() ? 0 : parts.front().sample_begin, target);
      reached = {plan.noise, sampled.mean_samples()};
      const double done = pixels * reached.mean_samples, all = done + plan.paths_left;
      if (plan.empty() || !begun || stopped(target.least)) return session_.film();
      look();
      double here = 0;  // of the plan's paths
      while (!plan.empty()) {
        const Clock::time_point begin = Clock::now();
        std::vector<PixelSamples> next =
            plan.take(options_.looks.empty() ? plan.paths : speed_ * shortest_ / 2);
        double paths = 0;
        for (const PixelSamples& each : next)
          paths += static_cast<double>(each.pixels.size()) * each.count;
        const bool complete = session_.render(
            std::move(next),
            [&](const SessionProgress& now) {
              heard(now);
              const double more = done + here + now.fraction * paths;
              if (progress_)
                progress_({more / all, static_cast<int>(more / pixels), now.samples_per_second,
                           reached.noise});
            },
            time_left());
        here += paths;
        speed_ = paths / std::max(1e-3, seconds_since(begin));
        if (!complete || stopped(target.least)) return session_.film();
        if (!plan.empty()) look();
      }
    }
  }

  double seconds() const { return seconds_since(start_); }
  double first_pass_seconds() const { return first_pass_seconds_; }
  bool cancelled() const { return options_.cancelled && options_.cancelled(); }

 private:
  /// Returns whether to end, with `done` samples of each pixel.
  bool stopped(std::uint32_t done) const {
    return cancelled() || (options_.time_limit && seconds() >= *options_.time_limit &&
                           done >= options_.least_samples);
  }
  std::optional<double> time_left() const {
    if (!options_.time_limit) return {};
    return std::max(0.0, *options_.time_limit - seconds());
  }
  /// A pass of one batch hears of an interrupt when it is complete.
  void heard(const SessionProgress& now) {
    if (now.samples_done > 0 && first_pass_seconds_ == 0) first_pass_seconds_ = seconds();
    speed_ = now.samples_per_second;
    if (cancelled()) session_.cancel();
  }
  /// Calls the looks whose time has come, with the film.
  void look() {
    std::optional<Film> film;
    for (std::size_t i = 0; i < looked_.size(); ++i) {
      if (seconds_since(looked_[i]) < options_.looks[i].seconds) continue;
      if (!film) film = session_.film();
      options_.looks[i].show(*film);
      looked_[i] = Clock::now();
    }
  }

  Session& session_;
  const RenderOptions& options_;
  const std::function<void(const Progress&)>& progress_;
  const Clock::time_point start_ = Clock::now();
  std::vector<Clock::time_point> looked_;
  double shortest_ = std::numeric_limits<double>::infinity();
  double speed_ = 1e6;  // paths a second
  double first_pass_seconds_ = 0;
};

}  // namespace

RenderResult render(Session& session, std::span<const Device> devices, const RenderOptions& options,
                    const std::function<void(const Progress&)>& progress) {
  RenderResult result;
  result.compile_seconds = session.compile_seconds();
  result.stage_compile_seconds = session.compile_seconds_by_stage();
  Course course(session, options, progress);
  if (progress) progress({0, 0, 0, {}});
  if (options.noise) {
    result.film = course.to_noise(*options.noise, result.reached.emplace());
  } else if (!session.is_even()) {
    const auto all = static_cast<std::uint32_t>(options.samples_per_pixel);
    NoiseReached ignored;
    result.film = course.to_noise({0, all, all}, ignored);
  }
  if (options.noise || !result.film.parts().empty()) {
    result.samples_per_pixel = static_cast<int>(std::lround(result.film.mean_samples()));
  } else {
    result.samples_per_pixel =
        narrow<int>(course.to_samples(static_cast<std::uint32_t>(options.samples_per_pixel)));
    if (options.film_on_device) result.device_film = session.film_on_device();
    if (!result.device_film) result.film = session.film();
  }
  result.interrupted = course.cancelled();
  result.first_pass_seconds = course.first_pass_seconds();
  result.render_seconds = course.seconds();
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
