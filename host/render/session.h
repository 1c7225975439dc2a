// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// One film from several devices.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "device/device.h"
#include "film/film.h"
#include "lower/flat_scene.h"

namespace caplet {

struct SessionOptions {
  std::uint32_t sample_begin = 0, sample_count = 16;  // of every pixel
  Layers layers = Layers::usual();
  std::uint32_t pass_samples = 0;                   // of every pixel that a device takes at a time; 0: what fills its batches
  std::optional<double> time_limit = std::nullopt;  // seconds; passes under way are finished
  std::size_t batch_paths = 0;                      // 0: chosen for each device
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

  /// Renders, on a thread a device. `progress`, when there is one, is called from these, one at a time, after each pass. Once
  /// only. Returns the samples that were finished (Film::parts). Throws RunError when a device fails.
  Film run(const std::function<void(const SessionProgress&)>& progress = {});

  /// Passes under way are finished, and no more begun. From any thread, a progress function included.
  void cancel() { cancelled_ = true; }
  bool is_cancelled() const { return cancelled_; }

 private:
  struct Worker;
  SessionOptions options_;
  std::vector<std::unique_ptr<Worker>> workers_;
  std::atomic<bool> cancelled_{false};
};

}  // namespace caplet
