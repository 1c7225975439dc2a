// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// One film from one or several devices, of a scene that may change.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "device/device.h"
#include "film/film.h"
#include "lower/changes.h"
#include "lower/flat_scene.h"
#include "render/device_scene.h"

namespace caplet {

struct SessionOptions {
  std::uint32_t sample_begin = 0;  // the first that is rendered of every pixel
  Layers layers = Layers::usual();
  std::uint32_t pass_samples = 0;  // of every pixel that a device takes at a time; 0: what fills its batches
  std::size_t batch_paths = 0;     // 0: chosen for each device
  std::uint32_t most_samples = 0;  // of every pixel that will be rendered, for small batches of small renders; 0: unknown
};

struct SessionProgress {
  std::uint32_t samples_done = 0;  // of every pixel, by all devices
  std::uint32_t sample_count = 0;  // asked for
  double samples_per_second = 0;   // of all pixels
};

/// Devices take passes of samples from a common list until there are no more. What comes out does not depend on which device did
/// what, on their number or on their speed, as long as they compute alike (devices of one kind do).
class Session {
 public:
  /// Sends the scene to every device and compiles. Throws RunError.
  Session(const FlatScene& scene, const FlatView& view, const std::vector<Device>& devices, const SessionOptions& options);
  ~Session();

  /// The scene as it now is, which differs from the last one in `changes`, and how it is looked at. The film is empty again, and
  /// begins at the first sample. Throws RunError.
  void update(const FlatScene& scene, const SceneChanges& changes, const FlatView& view);

  /// Begins with the samples of `film`, and goes on after the last of them. Throws InputError when it is not of this scene's
  /// layout.
  void resume(Film film);

  /// Adds the next `sample_count` samples of every pixel, on a thread a device, and returns how many of them were finished: fewer
  /// when it is cancelled, or its time limit (seconds) is over, which one pass is always made before. `progress`, when there is
  /// one, is called from these threads, one at a time, after each pass. Throws RunError when a device fails; the film is then
  /// empty.
  std::uint32_t render(std::uint32_t sample_count, const std::function<void(const SessionProgress&)>& progress = {},
                       std::optional<double> time_limit = {});

  /// All that was added up.
  Film film() const;

  /// The render under way finishes its passes and begins no more; where there is none, the next one does. From any thread, a
  /// progress function included.
  void cancel() { cancelled_ = true; }

  /// The scene on one of the devices, for queries while nothing is rendered.
  DeviceScene& scene_on(std::size_t device);

 private:
  struct Worker;
  void clear();

  SessionOptions options_;
  std::vector<std::unique_ptr<Worker>> workers_;
  std::optional<Film> before_;  // what it was resumed with
  std::uint32_t next_;          // the first sample that is not there
  std::atomic<bool> cancelled_{false};
};

}  // namespace caplet
