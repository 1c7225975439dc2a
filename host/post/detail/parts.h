// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The overlays.
#pragma once

#include <cstdint>
#include <span>

#include "film/image.h"
#include "post/detail/canvas.h"
#include "post/labels.h"
#include "post/scale_bar.h"

namespace caplet::post {

/// Returns the colour that contrasts with the background: black or white, sRGB.
std::array<float, 3> ink_for(const Shown& picture, const LayeredImage& layers);

void draw_depth_cue(Shown& picture, const LayeredImage& layers, double strength);
/// Draws silhouettes, lines between objects, and lines at large steps of depth. `joined`: numbers
/// of objects, between those of the same number there is no line; further objects are alone.
void draw_outline(Shown& picture, const LayeredImage& layers, double width,
                  std::span<const std::uint32_t> joined = {});
void draw_scale_bar(Shown& picture, const BarOnPicture& bar, const std::array<float, 3>& ink);
void draw_axes(Shown& picture, const Scene& scene, const std::array<float, 3>& ink);
void draw_color_bar(Shown& picture, const Legend& legend, const std::array<float, 3>& ink);
/// Draws a square for each of the legend's names, and how many did not find room.
void draw_names(Shown& picture, const Legend& legend, const std::array<float, 3>& ink);
/// Draws a ball with the colour of each direction, as the camera sees it.
void draw_directions(Shown& picture, const Scene& scene, const std::array<float, 3>& ink);

/// Draws each label that is in the picture, with a line to its point.
void draw_labels(Shown& picture, const LayeredImage& layers, const Scene& scene,
                 const std::vector<Label>& labels, const std::array<float, 3>& ink);

/// Return the height of capitals for the size of the picture, in pixels, and the margin.
double text_size(const Shown& picture);
double margin(const Shown& picture);

}  // namespace caplet::post
