// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Overlays on rendered pictures: scale bar, axes, colour bar, outlines, depth cue, labels. The
// film's layers do not change.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "film/image.h"
#include "film/layers.h"
#include "film/preview.h"
#include "post/labels.h"
#include "post/scale_bar.h"
#include "scene/scene.h"

namespace caplet::post {

struct Overlays {
  std::optional<ScaleBar> scale_bar;
  std::optional<double> outline;    // pixels
  std::optional<double> depth_cue;  // share of the background colour at the greatest depth, 0 to 1
  bool axes = false, color_bar = false;
  std::vector<Label> labels;

  bool any() const {
    return scale_bar || outline || depth_cue || axes || color_bar || !labels.empty();
  }
  /// Returns the layers that the overlays need.
  Layers layers() const;
};

/// Throws InputError that names the option of an overlay which the scene does not allow. `flags`:
/// the prefix of names, "--" in the program.
void check(const Overlays& overlays, const Sight& sight, const std::string& flags);

/// Draws overlays that were checked. `layers`: a picture of the same window with the channels of
/// Overlays::layers().
void draw(Shown& picture, const LayeredImage& layers, const Sight& sight, const Overlays& overlays);

}  // namespace caplet::post
