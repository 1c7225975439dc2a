// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Compares devices with the reference: millions of rays through traversal and hit lists, compared
// one by one.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "device/device.h"
#include "render/query.h"
#include "scene/scene.h"
#include "verify/compare.h"
#include "verify/statistics.h"

namespace caplet::verify {

/// A scene on one or more devices and in the reference.
class SceneCheck {
 public:
  /// The scene and the devices must outlive this. `moving`: the scene that `scene` is at `time`, in
  /// [0, 1] of its shutter; devices have it, and find hits then. Throws RunError, InputError.
  SceneCheck(const Scene& scene, const std::vector<Device>& devices, const Scene* moving = nullptr,
             float time = 0);

  /// The devices' answers for a ray, and the expected one. `found` and `outcomes` have an entry per
  /// device.
  struct Checked {
    std::size_t ray;
    const Expected& expected;
    std::span<const Found> found;
    std::span<Outcome> outcomes;
  };
  /// Calls visit for every ray, from many threads at once. Throws RunError.
  void check(std::span<const RayRecord> rays, const std::function<void(const Checked&)>& visit);

  const reference::SceneReference& reference() const { return reference_; }
  /// Returns the seconds in the devices' queries so far, an entry per device.
  const std::vector<double>& device_seconds() const { return device_seconds_; }

 private:
  reference::SceneReference reference_;
  Comparison comparison_;
  std::vector<std::unique_ptr<Query>> queries_;
  std::vector<double> device_seconds_;
  float time_;
};

/// The scene of a case: a file, or torture_scene(seed, round).
struct SceneName {
  std::string file;  // empty: a torture scene
  std::uint64_t seed = 0, round = 0;
  float time = 0;  // of a scene that moves: when rays see it, in [0, 1] of its shutter
};

/// Returns a scene that moves as it is at a time in [0, 1] of its shutter.
Scene seen_at(const Scene& scene, float time);

/// A ray on which a device and the reference disagree.
struct Failure {
  SceneName scene;
  RayRecord ray{};
  std::string family, device, driver;
  std::vector<Disagreement> disagreements;
  PickRecord nearest{};
  std::vector<PickRecord> list;
  std::vector<reference::SceneHit> expected;
};

struct DeviceReport {
  DeviceInfo info;
  Statistics statistics;
  double seconds = 0;             // of the device's queries
  std::vector<Failure> failures;  // the first failures
};

/// Compares the nearest hits of two devices. The reference decides which are right; this measures
/// how similar they are.
struct Difference {
  std::size_t first = 0, second = 0;  // indices into Report::devices
  std::uint64_t same = 0;             // bit for bit
  std::uint64_t other_t = 0;          // on the same surface, at another t
  std::uint64_t other_place = 0;      // on another primitive or surface, or one of them misses
  double worst_ulps = 0;              // of t, where the surface is the same
};

struct Report {
  std::vector<DeviceReport> devices;
  std::vector<Difference> differences;  // of each pair of devices
  double seconds = 0;
  bool interrupted = false;
  bool is_empty = false;                // the scene has no shapes, so no ray was traced
  std::uint64_t disagreements() const;  // of all devices
};

struct Options {
  std::uint64_t rays = 1'000'000;
  std::uint64_t seed = 0;
  std::size_t kept_failures = 100;  // per device
  std::function<void(std::uint64_t rays_done)> progress = {};
};

/// `scene`: the scene to verify, and its file; null: torture scenes, a new one every 250,000 rays.
/// A scene that moves is seen at another time every 65,472 rays. Rays are those of RaySource. Ends
/// early when interrupt_requested().
Report verify(const Scene* scene, const std::string& file, const std::vector<Device>& devices,
              const Options& options);

/// The ray through a pixel's centre.
struct HeatPixel {
  bool hit = false, grazed = false, disagrees = false;
  std::array<float, quantity_names.size()> in_bounds{};  // of the nearest crossing that both find
};
/// Traces the window of the scene's film in scan order, on the first device.
std::vector<HeatPixel> heatmap(const Scene& scene, const std::vector<Device>& devices);

}  // namespace caplet::verify
