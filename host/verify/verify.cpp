// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "verify/verify.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <map>
#include <mutex>

#include "base/clock.h"
#include "base/interrupt.h"
#include "lower/camera.h"
#include "lower/lower.h"
#include "scene/frozen.h"
#include "verify/torture.h"

namespace caplet::verify {

namespace {

// Most rays fit the small limit; the few that have more crossings are traced again. PoCL's batch is
// just below 65,536 rays.
constexpr std::size_t few_crossings = 32, many_crossings = std::size_t{1} << 16;
constexpr std::size_t chunk_rays = 65'536 - 64;
constexpr std::uint64_t rays_a_round = 250'000;

struct DeviceAnswers {
  std::vector<PickRecord> nearest;
  HitLists lists;
  std::map<std::size_t, std::vector<PickRecord>> long_lists;

  std::span<const PickRecord> list(std::size_t ray) const {
    if (const auto found = long_lists.find(ray); found != long_lists.end()) return found->second;
    return std::span(lists.crossings)
        .subspan(lists.begin[ray], lists.begin[ray + 1] - lists.begin[ray]);
  }
};

DeviceAnswers ask(Query& query, std::span<const RayRecord> rays, float time) {
  const std::vector<float> times(rays.size(), time);
  DeviceAnswers out{query.closest(rays, times), query.all(rays, few_crossings, times), {}};
  for (const std::size_t ray : out.lists.overflowed)
    out.long_lists[ray] =
        query.all(rays.subspan(ray, 1), many_crossings, std::span(times).first(1)).crossings;
  return out;
}

bool same_place(const PickRecord& a, const PickRecord& b) {
  return a.object == b.object && a.shape == b.shape && a.primitive == b.primitive &&
         a.surface == b.surface && a.leaving == b.leaving;
}

void count(Difference& out, const PickRecord& a, const PickRecord& b) {
  if (!same_place(a, b)) {
    ++out.other_place;
    return;
  }
  const auto bits_a = std::bit_cast<std::int32_t>(a.t), bits_b = std::bit_cast<std::int32_t>(b.t);
  ++(bits_a == bits_b ? out.same : out.other_t);
  // Both are positive, so the difference of their bits counts units in the last place.
  out.worst_ulps =
      std::max(out.worst_ulps, std::abs(static_cast<double>(bits_a) - static_cast<double>(bits_b)));
}

void count(Statistics& out, const reference::SceneReference& reference, const Expected& expected,
           const Found& found, const Outcome& outcome, RayFamily family) {
  const auto kind_of = [&](std::size_t primitive) {
    return reference::kind_of(reference.placed(primitive).primitive);
  };
  const auto once_a_kind = [&](const auto& primitives, auto&& add) {
    std::array<bool, reference::kind_names.size()> seen{};
    for (const std::size_t primitive : primitives)
      if (const std::size_t kind = kind_of(primitive); !std::exchange(seen[kind], true))
        add(out.kinds[kind]);
  };
  ++out.rays;
  out.hits += found.nearest.object != CAPLET_NONE;
  ++out.family_rays[static_cast<std::size_t>(family)];
  once_a_kind(expected.near, [](KindStatistics& kind) { ++kind.rays; });
  once_a_kind(outcome.grazed, [](KindStatistics& kind) { ++kind.grazed; });
  for (const Match& match : outcome.matches) {
    KindStatistics& kind = out.kinds[kind_of(match.primitive)];
    ++kind.hits;
    for (std::size_t q = 0; q < quantity_names.size(); ++q) {
      kind.quantities[q].in_bounds.add(match.deviations[q].in_bounds);
      kind.quantities[q].in_ulps.add(match.deviations[q].in_ulps);
    }
  }
  if (outcome.disagreements.empty()) return;
  ++out.disagreements;
  ++out.family_disagreements[static_cast<std::size_t>(family)];
  std::vector<std::size_t> primitives;
  for (const Disagreement& d : outcome.disagreements) {
    ++out.faults[static_cast<std::size_t>(d.fault)];
    if (d.primitive != no_primitive) primitives.push_back(d.primitive);
  }
  once_a_kind(primitives, [](KindStatistics& kind) { ++kind.disagreements; });
}

/// Returns when a round sees a scene that moves, a multiple of 2^-12: by the golden ratio, so that
/// any number of rounds have their times well apart.
float time_of(std::uint64_t seed, std::uint64_t round) {
  constexpr double golden_ratio = 0.6180339887498949;
  const double turns = static_cast<double>((seed + round) % 1'000'000) * golden_ratio;
  return static_cast<float>(std::floor((turns - std::floor(turns)) * 4096) / 4096);
}

/// The results that the threads of a run collect.
struct Work {
  std::vector<Statistics> statistics;
  std::vector<Difference> differences;
};

}  // namespace

Scene seen_at(const Scene& scene, float time) {
  const FilmSettings& film = scene.view.film;
  return frozen_at(scene, film.shutter_open + double{time} * film.open_time());
}

SceneCheck::SceneCheck(const Scene& scene, const std::vector<Device>& devices, const Scene* moving,
                       float time)
    : reference_(scene),
      comparison_(scene, reference_, moving != nullptr),
      device_seconds_(devices.size()),
      time_(time) {
  const FlatScene flat = lower(moving ? *moving : scene);
  for (const Device& device : devices) queries_.push_back(std::make_unique<Query>(flat, device));
}

void SceneCheck::check(std::span<const RayRecord> rays,
                       const std::function<void(const Checked&)>& visit) {
  for (std::size_t first = 0; first < rays.size(); first += chunk_rays) {
    const auto chunk = rays.subspan(first, std::min(chunk_rays, rays.size() - first));
    std::vector<DeviceAnswers> answers;
    for (std::size_t d = 0; d < queries_.size(); ++d) {
      const auto start = Clock::now();
      const double compiled = queries_[d]->compile_seconds();
      answers.push_back(ask(*queries_[d], chunk, time_));
      device_seconds_[d] += seconds_since(start) - (queries_[d]->compile_seconds() - compiled);
    }
    tbb::parallel_for(std::size_t{0}, chunk.size(), [&](std::size_t i) {
      const Expected expected = comparison_.expected(chunk[i]);
      std::vector<Found> found;
      std::vector<Outcome> outcomes;
      for (const DeviceAnswers& answer : answers) {
        found.push_back({answer.nearest[i], answer.list(i)});
        outcomes.push_back(comparison_.compare(expected, found.back()));
      }
      visit({first + i, expected, found, outcomes});
    });
  }
}

std::uint64_t Report::disagreements() const {
  std::uint64_t out = 0;
  for (const DeviceReport& device : devices) out += device.statistics.disagreements;
  return out;
}

Report verify(const Scene* scene, const std::string& file, const std::vector<Device>& devices,
              const Options& options) {
  const auto start = Clock::now();
  Report report;
  Work empty;
  for (std::size_t d = 0; d < devices.size(); ++d) {
    report.devices.push_back({devices[d].info(), {}, 0, {}});
    empty.statistics.emplace_back();
    for (std::size_t other = d + 1; other < devices.size(); ++other)
      empty.differences.push_back({d, other});
  }
  tbb::enumerable_thread_specific<Work> work(empty);
  std::mutex mutex;

  std::uint64_t done = 0;
  for (std::uint64_t round = 0; done < options.rays && !report.interrupted; ++round) {
    const bool is_moving = scene && moves(*scene);
    const SceneName name{file, options.seed, round, is_moving ? time_of(options.seed, round) : 0};
    const Scene other = is_moving ? seen_at(*scene, name.time)
                        : scene   ? Scene{}
                                  : torture_scene(options.seed, round);
    const Scene& shown = scene && !is_moving ? *scene : other;
    SceneCheck check(shown, devices, is_moving ? scene : nullptr, name.time);
    if (check.reference().size() == 0) {
      report.is_empty = true;
      break;
    }
    const RaySource source(shown, check.reference(), options.seed + (scene ? 0 : round));
    const std::uint64_t end =
        scene && !is_moving
            ? options.rays
            : std::min(options.rays, done + (is_moving ? chunk_rays : rays_a_round));
    while (done < end) {
      if (interrupt_requested()) {
        report.interrupted = true;
        break;
      }
      const std::size_t size = std::min<std::uint64_t>(chunk_rays, end - done);
      std::vector<RayRecord> rays(size);
      std::vector<RayFamily> families(size);
      tbb::parallel_for(std::size_t{0}, size, [&](std::size_t i) {
        const VerifyRay made = source.ray(done + i);
        rays[i] = made.ray;
        families[i] = made.family;
      });
      std::vector<std::vector<std::pair<std::size_t, Failure>>> failures(devices.size());
      check.check(rays, [&](const SceneCheck::Checked& ray) {
        Work& own = work.local();
        for (std::size_t d = 0; d < devices.size(); ++d) {
          count(own.statistics[d], check.reference(), ray.expected, ray.found[d], ray.outcomes[d],
                families[ray.ray]);
          if (ray.outcomes[d].disagreements.empty()) continue;
          const std::lock_guard lock(mutex);
          failures[d].push_back({ray.ray,
                                 {name,
                                  rays[ray.ray],
                                  family_names[static_cast<std::size_t>(families[ray.ray])],
                                  devices[d].info().name,
                                  devices[d].info().driver,
                                  ray.outcomes[d].disagreements,
                                  ray.found[d].nearest,
                                  {ray.found[d].list.begin(), ray.found[d].list.end()},
                                  ray.expected.hits}});
        }
        for (Difference& difference : own.differences)
          count(difference, ray.found[difference.first].nearest,
                ray.found[difference.second].nearest);
      });
      // Results are in the order of the rays, independent of the threads.
      for (std::size_t d = 0; d < devices.size(); ++d) {
        std::ranges::sort(failures[d], {}, &std::pair<std::size_t, Failure>::first);
        for (auto& [ray, failure] : failures[d])
          if (report.devices[d].failures.size() < options.kept_failures)
            report.devices[d].failures.push_back(std::move(failure));
      }
      done += size;
      if (options.progress) options.progress(done);
    }
    for (std::size_t d = 0; d < devices.size(); ++d)
      report.devices[d].seconds += check.device_seconds()[d];
  }

  report.differences = empty.differences;
  for (const Work& own : work) {
    for (std::size_t d = 0; d < devices.size(); ++d)
      report.devices[d].statistics.add(own.statistics[d]);
    for (std::size_t i = 0; i < own.differences.size(); ++i) {
      Difference& sum = report.differences[i];
      sum.same += own.differences[i].same;
      sum.other_t += own.differences[i].other_t;
      sum.other_place += own.differences[i].other_place;
      sum.worst_ulps = std::max(sum.worst_ulps, own.differences[i].worst_ulps);
    }
  }
  report.seconds = seconds_since(start);
  return report;
}

std::vector<HeatPixel> heatmap(const Scene& scene, const std::vector<Device>& devices) {
  const Scene opening = moves(scene) ? seen_at(scene, 0) : Scene{};
  SceneCheck check(moves(scene) ? opening : scene, {devices.front()});
  FlatView frame;
  lower_camera(scene, frame);
  const ViewRecord& p = frame.view;
  std::vector<RayRecord> rays;
  for (uint y = 0; y < p.crop_height; ++y)
    for (uint x = 0; x < p.crop_width; ++x)
      rays.push_back(
          ray_of_pixel(scene, static_cast<int>(p.crop_x + x), static_cast<int>(p.crop_y + y)));
  std::vector<HeatPixel> out(rays.size());
  check.check(rays, [&](const SceneCheck::Checked& ray) {
    HeatPixel& pixel = out[ray.ray];
    const Outcome& outcome = ray.outcomes[0];
    pixel.hit = ray.found[0].nearest.object != CAPLET_NONE;
    pixel.grazed = !outcome.grazed.empty();
    pixel.disagrees = !outcome.disagreements.empty();
    if (ray.expected.hits.empty()) return;
    for (const Match& match : outcome.matches)
      if (match.primitive == ray.expected.hits[0].index) {
        for (std::size_t q = 0; q < quantity_names.size(); ++q)
          pixel.in_bounds[q] = static_cast<float>(match.deviations[q].in_bounds);
        break;
      }
  });
  return out;
}

}  // namespace caplet::verify
