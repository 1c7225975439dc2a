// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Renders a lowered scene: the wavefront path tracer's host side.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "device/device.h"
#include "lower/flat_scene.h"
#include "render/renderer.h"

namespace caplet {

struct RenderOptions {
  int samples_per_pixel = 16;
  std::optional<double> time_limit;  // seconds; the pass under way is finished
  std::function<bool()> cancelled;   // asked after each pass: no more of them when true
  std::size_t batch_paths = 0;       // 0: chosen for the device
  bool time_stages = false;          // wait for each stage and report its seconds (costs some on GPUs)
  bool film_on_device = false;       // RenderResult::device_film in place of film
  Layers layers = Layers::all();     // of the film
};

struct Progress {
  double fraction = 0;  // 0..1
  int samples_done = 0;
  double samples_per_second = 0;  // paths
};

struct RenderResult {
  Film film;
  DeviceFilm device_film;     // the same, to be read in parts
  int samples_per_pixel = 0;  // finished
  bool interrupted = false;   // cancelled
  double compile_seconds = 0, render_seconds = 0, first_pass_seconds = 0;
  std::uint64_t camera_rays = 0, bounce_rays = 0, shadow_rays = 0;
  std::uint64_t peak_device_bytes = 0;
  std::vector<std::pair<std::string, double>> stage_compile_seconds, stage_seconds;
};

/// Renders pass by pass; stops when it is cancelled or its time is over. Throws RunError.
RenderResult render(const FlatScene& scene, const FlatView& view, const Device& device, const RenderOptions& options,
                    const std::function<void(const Progress&)>& progress);

}  // namespace caplet
