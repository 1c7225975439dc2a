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

struct RenderOptions {
  std::optional<double> time_limit;  // seconds; the pass of samples in progress is finished
  std::function<void(const RenderProgress&)> progress;
  std::optional<NoiseTarget> noise = {};  // in place of a number of samples
};

/// Renders the scene's picture to options.noise or Scene::noise_target, else with its number of
/// samples, and blocks until it is done. Throws RunError, and InputError when the scene exceeds a
/// limit, when the target is out of range, and for a noise with a sampler whose points are even at
/// one number of samples alone (zsobol, stratified).
CAPLET_API Film render(const Scene& scene, const Device& device, const RenderOptions& options = {},
                       const ExtraLayers& layers = {});

CAPLET_END
