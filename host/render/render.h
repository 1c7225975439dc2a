// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Renders a lowered scene: this is the host side of the wavefront path tracer.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "device/device.h"
#include "film/sample_plan.h"
#include "lower/flat_scene.h"
#include "render/renderer.h"
#include "render/session.h"

namespace caplet {

/// Look is called between passes of a render, about every so many seconds, with the film so far.
/// The final film does not depend on it.
struct Look {
  double seconds = 1;
  std::function<void(const Film&)> show;
};

struct RenderOptions {
  std::uint32_t sample_begin = 0;  // the first sample of every pixel
  int samples_per_pixel = 16;      // from that one on
  std::optional<NoiseTarget>
      noise;  // in its place: samples of each pixel until it has little noise
  std::optional<double> time_limit;  // seconds; the pass under way is finished
  std::uint32_t least_samples = 0;   // of each pixel, however long they take
  std::function<bool()> cancelled;   // asked after each batch: no more passes when true
  std::size_t batch_paths = 0;       // 0: chosen for the device
  bool time_stages = false;  // wait for each stage and report its seconds (costs some on GPUs)
  bool film_on_device =
      false;             // RenderResult::device_film in place of film, where it is on one device
  double patience = 60;  // SessionOptions::patience
  Layers layers = Layers::all();  // of the film
  std::vector<Look> looks = {};
};

struct Progress {
  double fraction = 0;  // 0..1
  int samples_done = 0;
  double samples_per_second = 0;  // paths
  std::optional<double> noise;    // of the picture, when it is rendered to a noise and it is known
};

/// NoiseReached is how far a render to a NoiseTarget came.
struct NoiseReached {
  double noise = 0;  // as its pixels' neighbours say
  double mean_samples = 0;
};

struct RenderResult {
  Film film;
  std::optional<DeviceFilm> device_film;  // the same, to be read in parts
  int samples_per_pixel = 0;              // in the film; in the mean, where it is one of a target
  std::optional<NoiseReached> reached;
  bool interrupted = false;     // cancelled
  std::optional<double> noise;  // of the picture that was written, in the space it was rendered in
  double compile_seconds = 0, render_seconds = 0, first_pass_seconds = 0;
  std::uint64_t camera_rays = 0, bounce_rays = 0, shadow_rays = 0;
  std::uint64_t peak_device_bytes = 0;
  StageSeconds stage_compile_seconds, stage_seconds;
  std::vector<DeviceWork> devices;
};

/// Renders on all of the devices together (Session); stops when it is cancelled or its time is
/// over. `progress` is called on any thread, once at a time: before the first sample, and after
/// each batch of paths. Throws RunError.
RenderResult render(const FlatScene& scene, const FlatView& view, std::span<const Device> devices,
                    const RenderOptions& options,
                    const std::function<void(const Progress&)>& progress);
RenderResult render(const FlatScene& scene, const FlatView& view, const Device& device,
                    const RenderOptions& options,
                    const std::function<void(const Progress&)>& progress);

/// Returns the options of a session for renders with these options, for pictures that follow each
/// other.
SessionOptions session_options(const RenderOptions& options);
/// Renders a picture of a session's view, whose film is empty (Session::update) or holds the first
/// of its samples (Session::resume). The counts of rays, and the work of devices, are those of the
/// session from its beginning.
RenderResult render(Session& session, std::span<const Device> devices, const RenderOptions& options,
                    const std::function<void(const Progress&)>& progress);

}  // namespace caplet
