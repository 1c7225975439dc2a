// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The wavefront path tracer's host side: passes over windows and samples of a view, into a film on the device.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "device/device.h"
#include "lower/lower.h"
#include "render/buffers.h"
#include "render/device_scene.h"

namespace caplet {

/// Pixels [x, x + width) times [y, y + height) of the full image.
struct Window {
  int x = 0, y = 0, width = 0, height = 0;
};

/// What a renderer has done so far.
struct RayCounts {
  std::uint64_t camera = 0, bounce = 0, shadow = 0;
  std::uint64_t not_finite = 0;  // samples that count as black, as their radiance was not a number
};

class Renderer {
 public:
  /// Renders `scene`, which must outlive this, as `view` shows it. Compiles what is not compiled yet. `batch_paths`: most paths
  /// under way at a time; 0: chosen for the device. `most_paths`: what the passes to come have at the most, for small renders.
  Renderer(DeviceScene& scene, const FlatView& view, std::size_t batch_paths = 0, std::size_t most_paths = SIZE_MAX);

  /// Another view of the scene as it now is; the film is empty again.
  void reset(const FlatView& view);

  /// The film's window.
  Window film_window() const { return film_window_; }
  /// Adds samples [sample_begin, sample_begin + sample_count) of every pixel of `window`, which lies within the film's.
  /// `batch_done`, when there is one, is told the number of the window's pixels that are finished. Throws RunError.
  void pass(const Window& window, std::uint32_t sample_begin, std::uint32_t sample_count,
            const std::function<void(std::size_t)>& batch_done = {});

  /// Sums of the film's window, row-major.
  const Buffer<FilmRecord>& film() const { return film_.film; }
  std::size_t batch_paths() const { return batch_paths_; }
  const RayCounts& rays() const { return rays_; }

 private:
  void batch(const BatchRecord& record);
  void clear_counters();
  void clear_film();

  DeviceScene& scene_;
  std::size_t batch_paths_;
  std::uint32_t sort_bits_;
  Window film_window_;
  SensorBuffers sensor_;
  PathBuffers paths_;
  FilmBuffers film_;
  RayCounts rays_;
};

/// Bytes of the state of a full batch of paths on a CPU or another device (smaller renders take smaller batches).
std::uint64_t batch_bytes(bool cpu);

}  // namespace caplet
