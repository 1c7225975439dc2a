// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Renders a scene to a film.
#pragma once

#include <functional>
#include <optional>

#include "caplet/device.h"
#include "caplet/film.h"
#include "caplet/scene.h"

CAPLET_BEGIN

struct RenderProgress {
  double fraction = 0;  // 0 to 1
  double samples_per_second = 0;
};

/// A render to a noise gives each pixel as many samples as it needs for it. The noise is the root
/// of the mean, over the pixels that show something, of the variance of the mean of a pixel's
/// samples over the square of the luminance around it, with a quarter of the picture's mean
/// luminance added.
struct NoiseTarget {
  double noise = 0.05;                           // 1e-5 to 1
  int least_samples = 16, most_samples = 16384;  // of a pixel
};

struct RenderOptions {
  std::optional<double> time_limit;  // seconds; the pass of samples in progress is finished
  std::function<void(const RenderProgress&)> progress;
  std::optional<NoiseTarget> noise = {};  // in place of a number of samples
};

/// Renders the scene's picture with its number of samples, or to a noise, and blocks until it is
/// done. Throws RunError, and InputError when the scene exceeds a limit, when the target is out of
/// range, and for a noise with a sampler whose points are even at one number of samples alone
/// (zsobol, stratified).
CAPLET_API Film render(const Scene& scene, const Device& device, const RenderOptions& options = {},
                       const ExtraLayers& layers = {});

CAPLET_END
