// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The options of `caplet render`.
#pragma once

#include <CLI/CLI.hpp>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cli/depth_options.h"
#include "cli/film_output.h"
#include "cli/matte_options.h"
#include "cli/options.h"
#include "import/import.h"
#include "post/overlay.h"

namespace caplet::cli {

struct RenderFlags {
  Encoding encoding = Encoding::automatic;
  std::vector<std::string> scenes;
  std::vector<std::string> outputs;
  std::string preview, stats, device, size, crop, frames, poses, play, preset;
  ImportOptions import_options;
  post::Overlays overlays;
  std::optional<std::string> layers;
  std::optional<int> samples_per_pixel, least_samples, max_depth;
  std::optional<std::uint32_t> seed;
  std::optional<double> noise, time_limit, clamp, separation, convergence;
  std::optional<NoiseSpace> noise_space;
  std::string layout, display;
  FilmFlags film;
  MatteFlags mattes;
  DepthFlags depth;
  double patience = 60;
  std::size_t batch_paths = 0;
  std::uint32_t turntable = 0;
  double frames_a_second = 25, shutter = 0;
  bool variance = false, denoise = false, quiet = false, skip_existing = false;
  bool has_frames() const {
    return turntable > 0 || !frames.empty() || !poses.empty() || !play.empty();
  }
};

/// Adds the options but for the scene files to the command, which sets `o`.
void add_render_flags(CLI::App& command, RenderFlags& o);

}  // namespace caplet::cli
