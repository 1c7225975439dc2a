// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Computes the length of a scale bar.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace caplet::post {

/// The scene properties that overlays need: a scene without its content, the bounds of its shapes,
/// and which of them go on in each other (joined_objects).
struct Sight {
  Sight(const Scene& of);
  Scene scene;  // only its camera, film, unit, axes and legend
  Bounds bounds;
  std::vector<std::uint32_t> joined;
};

struct ScaleBar {
  double length = 0;  // 0: a round length
  std::string unit;   // as people write it; empty: the scene's
};

/// Parses "": a round length; "50 um", "0.2mm", "50": with or without a unit. Throws InputError
/// that names `flag`.
ScaleBar parse_scale_bar(const std::string& text, const std::string& flag);

/// A bar whose length is correct everywhere, or at one distance from the camera.
struct BarOnPicture {
  double pixels = 0;
  std::string label;               // "50 µm"
  std::optional<double> distance;  // for perspective: that of the centre of the visible part
};

/// Returns the bar on a picture of the scene: as requested, or the longest of 1, 2 and 5 times a
/// power of ten that is at most a quarter of the film's width. Throws InputError that names `flag`
/// when the scene's unit is not a length or the bar is wider than the film.
BarOnPicture bar_of(const ScaleBar& asked, const Sight& sight, const std::string& flag);

}  // namespace caplet::post
