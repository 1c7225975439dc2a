// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "render/known_answers.h"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <span>

#include "base/check.h"
#include "base/log.h"
#include "device/self_test.h"
#include "lower/lower.h"
#include "render/detail/known_rays.h"
#include "render/device_scene.h"
#include "render/query.h"

namespace caplet {

namespace {

// Coordinates are at most 100 and directions at least 0.2 long: positions, rounded to 2^-24 of 100
// a few times over and seen at 17 degrees or more (and stretched by 2 at most), move t by some
// 1e-4. Anything larger is a fault, and faults are larger: this tests for wrong code, not for
// rounding.
constexpr double t_tolerance = 2e-3;

/// Tally counts wrong rays by check and shape.
class Tally {
 public:
  explicit Tally(const std::vector<KnownRay>& rays) {
    for (const KnownRay& ray : rays) ++asked_[ray.kind];
  }
  void add(const char* check, const KnownRay& ray, const std::string& detail) {
    Wrong& wrong = wrong_[{ray.kind, check}];
    if (wrong.rays == 0) wrong.first = detail;
    if (wrong.last != &ray) ++wrong.rays;
    wrong.last = &ray;
  }
  std::vector<std::string> lines() const {
    std::vector<std::string> out;
    for (const auto& [of, wrong] : wrong_)
      out.push_back(fmt::format("{}: {}: {} of {} rays are wrong; the first {}",
                                shape_name(of.first), of.second, wrong.rays, asked_.at(of.first),
                                wrong.first));
    return out;
  }

 private:
  struct Wrong {
    std::size_t rays = 0;
    std::string first;
    const KnownRay* last = nullptr;  // a ray has several crossings
  };
  std::map<int, std::size_t> asked_;
  std::map<std::pair<int, std::string>, Wrong> wrong_;
};

/// Seen is what any of the kernels reports of a crossing.
struct Seen {
  bool hit = false;
  double t = 0;
  std::uint32_t object = CAPLET_NONE;
  bool leaving = false;
};

std::string text_of(const KnownRay& ray) {
  if (ray.crossings.empty()) return "nothing";
  return fmt::format("t = {:.6g}", ray.crossings.front().t);
}

/// Returns the difference; it is empty when the kernel is right.
std::string difference(const KnownRay& ray, const Seen& seen, std::size_t which) {
  if (which >= ray.crossings.size())
    return seen.hit ? fmt::format("finds t = {:.6g}, not nothing", seen.t) : "";
  const KnownCrossing& known = ray.crossings[which];
  if (!seen.hit) return fmt::format("finds nothing, not t = {:.6g}", known.t);
  if (!(std::abs(seen.t - known.t) <= t_tolerance))
    return fmt::format("finds t = {:.6g}, not {:.6g}", seen.t, known.t);
  if (seen.object != ray.object)
    return fmt::format("finds object {}, not {}", seen.object, ray.object);
  if (known.side != KnownCrossing::Side::either &&
      seen.leaving != (known.side == KnownCrossing::Side::leaving))
    return seen.leaving ? "leaves where it enters" : "enters where it leaves";
  return "";
}

Seen seen_of(const FlatScene& flat, const HitRecord& hit) {
  if (hit.slot == CAPLET_NONE) return {};
  Seen out{true, static_cast<double>(hit.t), CAPLET_NONE, (hit.surface & CAPLET_LEAVING) != 0};
  if ((hit.slot & ~CAPLET_SLOT_LINKED) >= flat.leaves.size()) return out;
  const std::uint32_t primitive = primitive_at(flat.leaves, hit.slot);
  if (primitive / CAPLET_PAGE_PRIMITIVES >= flat.primitive_geometry.size()) return out;
  out.object = flat.geometries[geometry_of(flat.primitive_geometry, primitive)].object;
  if (hit.instance < flat.instances.size() && flat.instances[hit.instance].object != CAPLET_NONE)
    out.object = flat.instances[hit.instance].object;
  return out;
}

/// Checks that the normal of a crossing is a unit vector against the ray, and that its point lies
/// on the ray.
std::string record_fault(const RayRecord& ray, const PickRecord& pick) {
  const std::array<double, 3> o{ray.ox, ray.oy, ray.oz}, d{ray.dx, ray.dy, ray.dz};
  double off = 0, dd = 0, nn = 0, dn = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double error =
        o[k] + static_cast<double>(pick.t) * d[k] - static_cast<double>(pick.point[k]);
    const double n = static_cast<double>(pick.normal[k]);
    off += error * error;
    dd += d[k] * d[k];
    nn += n * n;
    dn += d[k] * n;
  }
  if (!(off <= t_tolerance * t_tolerance * dd))
    return fmt::format("has its point {:.3g} away from the ray", std::sqrt(off));
  if (!(std::abs(nn - 1) < 1e-3))
    return fmt::format("has a normal of length {:.6g}", std::sqrt(nn));
  if (!(dn < 0)) return "has a normal along the ray";
  return "";
}

Seen seen_of(const PickRecord& pick) {
  return {std::isfinite(pick.t), static_cast<double>(pick.t), pick.object, pick.leaving != 0};
}

/// TracedPaths is what the stages of a render find for rays.
struct TracedPaths {
  std::vector<HitRecord> hits;  // of each ray
  std::vector<HitRecord>
      camera_hits;         // the same by extend_camera; none where there is no such stage
  std::vector<bool> free;  // each shadow ray
};

TracedPaths trace(DeviceScene& scene, std::span<const RayRecord> rays,
                  std::span<const RayRecord> shadows) {
  const std::size_t paths = std::max(rays.size(), shadows.size());
  std::vector<Stage> stages{Stage::extend, Stage::connect};
  if (scene.has_camera_stage()) stages.push_back(Stage::extend_camera);
  scene.kernels().compile(stages);
  PathBuffers buffers(scene.device(), paths, 1,
                      PathNeeds{.layers = Layers::none(), .times = scene.moves()});
  std::vector<uint> all(paths);
  std::iota(all.begin(), all.end(), 0u);
  buffers.rays.path_ray.write(rays);
  buffers.queues.queue.write(std::span(all).first(rays.size()));
  buffers.shadows.path_shadow.write(shadows);
  buffers.shadows.queue_shadow.write(std::span(all).first(shadows.size()));
  buffers.shadows.path_shadow_target.write(
      std::vector<ShadowTarget>(shadows.size(), {CAPLET_NONE, CAPLET_NONE, INFINITY, 0}));
  buffers.shadows.path_shadow_radiance.write(std::vector<float4>(shadows.size(), {1, 1, 1, 1}));
  buffers.radiance.path_radiance.write(std::vector<float4>(shadows.size(), {0, 0, 0, 0}));
  if (scene.moves()) buffers.times.path_time.write(std::vector<float>(paths));
  Bindings bindings = scene.bindings();
  buffers.bind(bindings);
  scene.kernels().run(Stage::extend, bindings, rays.size());
  scene.kernels().run(Stage::connect, bindings, shadows.size());
  TracedPaths out;
  const auto hits = [&] {
    std::vector<HitRecord> read = buffers.rays.path_hit.read();
    read.resize(rays.size());
    return read;
  };
  out.hits = hits();
  if (scene.has_camera_stage()) {
    buffers.rays.path_hit.clear();  // what it leaves out is not what extend found
    scene.kernels().run(Stage::extend_camera, bindings, rays.size());
    out.camera_hits = hits();
  }
  const std::vector<float4> seen = buffers.radiance.path_radiance.read();
  for (std::size_t i = 0; i < shadows.size(); ++i) out.free.push_back(seen[i].x == 1.0f);
  return out;
}

void check_render(const KnownScene& known, const FlatScene& flat, const Device& device,
                  Tally& tally) {
  const std::size_t count = known.rays.size();
  DeviceScene scene(device, flat);
  // Each shadow ray ends just before its ray's first crossing and just behind it; where there is
  // none, twice at its end.
  std::vector<RayRecord> rays, shadows;
  for (const KnownRay& ray : known.rays) {
    rays.push_back(ray.ray);
    for (const double share : {0.98, 1.02}) {
      shadows.push_back(ray.ray);
      if (!ray.crossings.empty())
        shadows.back().t_max = static_cast<float>(share * ray.crossings.front().t);
    }
  }
  const TracedPaths traced = trace(scene, rays, shadows);
  for (std::size_t i = 0; i < count; ++i) {
    const KnownRay& ray = known.rays[i];
    if (const std::string wrong = difference(ray, seen_of(flat, traced.hits[i]), 0); !wrong.empty())
      tally.add("nearest crossing (extend)", ray, wrong);
    if (!traced.camera_hits.empty())
      if (const std::string wrong = difference(ray, seen_of(flat, traced.camera_hits[i]), 0);
          !wrong.empty())
        tally.add("nearest crossing (extend_camera)", ray, wrong);
    if (!traced.free[2 * i])
      tally.add("any crossing (connect)", ray, "is blocked where it is free");
    if (traced.free[2 * i + 1] != ray.crossings.empty())
      tally.add(
          "any crossing (connect)", ray,
          traced.free[2 * i + 1] ? "is free where " + text_of(ray) + " blocks it" : "is blocked");
  }
}

void check_queries(const KnownScene& known, const FlatScene& flat, const Device& device,
                   const Trial& trial, Tally& tally) {
  std::vector<RayRecord> rays;
  for (const KnownRay& ray : known.rays) rays.push_back(ray.ray);
  Query query(flat, device, {.batch_rays = rays.size()});
  const auto check = [&](const char* name, const KnownRay& ray, const PickRecord& pick,
                         std::size_t which) {
    std::string wrong = difference(ray, seen_of(pick), which);
    if (wrong.empty() && seen_of(pick).hit) wrong = record_fault(ray.ray, pick);
    if (!wrong.empty()) tally.add(name, ray, wrong);
  };
  if (trial.nearest) {
    const std::vector<PickRecord> picks = query.closest(rays);
    for (std::size_t i = 0; i < rays.size(); ++i)
      check("nearest crossing (pick)", known.rays[i], picks[i], 0);
  }
  if (!trial.lists) return;
  constexpr const char* name = "all crossings (pick_all)";
  const HitLists lists = query.all(rays, 8);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const KnownRay& ray = known.rays[i];
    const std::size_t found = lists.begin[i + 1] - lists.begin[i];
    if (found != ray.crossings.size())
      tally.add(name, ray, fmt::format("finds {}, not {}", found, ray.crossings.size()));
    else
      for (std::size_t k = 0; k < found; ++k)
        check(name, ray, lists.crossings[lists.begin[i] + k], k);
  }
}

std::string key_of(const Trial& trial) {
  return fmt::format("known answers {:x} {:d}{:d}{:d}", shapes_on_trial(trial.shapes), trial.render,
                     trial.nearest, trial.lists);
}

/// Returns what a trial's result depends on beside the device: its kernels and how they are built.
std::vector<std::string> trial_texts(const Device& device, const Trial& trial) {
  std::vector<std::string> out{key_of(trial), name_of(device.encoding()),
                               kernel_source("probe/self_test.cl"),
                               kernel_source("probe/layout.cl")};
  if (trial.render)
    out.insert(out.end(), {stage_source(Stage::extend), stage_source(Stage::extend_camera),
                           stage_source(Stage::connect)});
  if (trial.nearest) out.push_back(stage_source(Stage::pick));
  if (trial.lists)
    out.insert(out.end(), {stage_source(Stage::pick_all), stage_source(Stage::pick_list)});
  return out;
}

}  // namespace

std::vector<std::string> known_answer_failures(const Device& device, const Trial& trial) {
  const KnownScene known = known_scene(trial.shapes);
  const FlatScene flat = lower(known.scene, links_of_known());
  Tally tally(known.rays);
  if (trial.render) check_render(known, flat, device, tally);
  if (trial.nearest || trial.lists) check_queries(known, flat, device, trial, tally);
  return tally.lines();
}

bool needs_trial(const Device& device, const Trial& trial) {
  return self_test_is_due(device, trial_texts(device, trial));
}

void try_device(const Device& device, const Trial& trial) {
  self_test(device);
  if (!needs_trial(device, trial)) return;
  if (const std::vector<std::string> failures = known_answer_failures(device, trial);
      !failures.empty())
    refuse_device(device, failures);
  remember_trial(device, trial);
}

void remember_trial(const Device& device, const Trial& trial) {
  remember_self_test(device, trial_texts(device, trial));
}

}  // namespace caplet
