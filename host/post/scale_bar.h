// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// How long a scale bar is.
#pragma once

#include <optional>
#include <string>

#include "scene/scene.h"

namespace caplet::post {

/// What overlays are of: a scene without what it consists of, and the box around its shapes.
struct Sight {
  Sight(const Scene& of);
  Scene scene;  // its camera, film, unit, axes and legend alone
  Bounds bounds;
};

struct ScaleBar {
  double length = 0;  // 0: a round one
  std::string unit;   // as people write it; empty: the scene's
};

/// "": a round length; "50 um", "0.2mm", "50": with or without a unit. Throws InputError naming `flag`.
ScaleBar parse_scale_bar(const std::string& text, const std::string& flag);

/// Where the bar's length is that of the picture: everywhere, or at one distance from the camera.
struct BarOnPicture {
  double pixels = 0;
  std::string label;               // "50 µm"
  std::optional<double> distance;  // in perspective: of the middle of what is seen
};

/// The bar on a picture of the scene: what is asked for, or the longest of 1, 2 and 5 times a power of ten that is at most a
/// quarter of the film's width. Throws InputError naming `flag` when the scene's unit is not of length's or the bar is wider than
/// the film.
BarOnPicture bar_of(const ScaleBar& asked, const Sight& sight, const std::string& flag);

}  // namespace caplet::post
