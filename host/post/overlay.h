// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// What is drawn on a picture when it is rendered: scale bar, axes, colour bar, outlines, depth cue. The film's layers stay.
#pragma once

#include <optional>
#include <string>

#include "film/image.h"
#include "film/layers.h"
#include "film/preview.h"
#include "post/scale_bar.h"
#include "scene/scene.h"

namespace caplet::post {

struct Overlays {
  std::optional<ScaleBar> scale_bar;
  std::optional<double> outline;    // pixels wide
  std::optional<double> depth_cue;  // of the farthest, 0 to 1: the share of the background in its colour
  bool axes = false, color_bar = false;

  bool any() const { return scale_bar || outline || depth_cue || axes || color_bar; }
  /// What the film must have for them.
  Layers layers() const;
};

/// Throws InputError naming the option of what the scene cannot have drawn on it.
/// `flags`: what stands before the names, "--" of the program's.
void check(const Overlays& overlays, const Sight& sight, const std::string& flags);

/// Draws them, once they are checked. `layers`: a picture of the same window with the channels of Overlays::layers().
void draw(Shown& picture, const LayeredImage& layers, const Sight& sight, const Overlays& overlays);

}  // namespace caplet::post
