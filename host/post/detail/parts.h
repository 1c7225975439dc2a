// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Each of the overlays.
#pragma once

#include "film/image.h"
#include "post/detail/canvas.h"
#include "post/scale_bar.h"

namespace caplet::post {

/// The colour that is seen on what is behind the shapes: black or white, sRGB.
std::array<float, 3> ink_for(const Shown& picture, const LayeredImage& layers);

void draw_depth_cue(Shown& picture, const LayeredImage& layers, double strength);
/// Silhouettes against what is behind, lines between objects, and where one part stands far before another.
void draw_outline(Shown& picture, const LayeredImage& layers, double width);
void draw_scale_bar(Shown& picture, const BarOnPicture& bar, const std::array<float, 3>& ink);
void draw_axes(Shown& picture, const Scene& scene, const std::array<float, 3>& ink);
void draw_color_bar(Shown& picture, const Legend& legend, const std::array<float, 3>& ink);

/// The height of capitals on a picture of that size, in pixels, and the space that is left to its edges.
double text_size(const Shown& picture);
double margin(const Shown& picture);

}  // namespace caplet::post
