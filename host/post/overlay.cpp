// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "post/overlay.h"

#include "base/error.h"
#include "post/detail/parts.h"

namespace caplet::post {

Layers Overlays::layers() const {
  Layers out = Layers::none();
  if (depth_cue || outline) out = out.with(Layer::depth);
  if (outline) out = out.with(Layer::object);
  return out;
}

void check(const Overlays& overlays, const Scene& scene) {
  if (overlays.scale_bar) bar_of(*overlays.scale_bar, scene, "--scale-bar");
  if (overlays.color_bar && !scene.legend)
    throw InputError(SourceLocation{"--color-bar"},
                     "the scene's colours tell no number (those of molecules do with --color bfactor, of neurons with --color "
                     "order or a file)");
}

void draw(Shown& picture, const LayeredImage& layers, const Scene& scene, const Overlays& overlays) {
  const std::array<float, 3> ink = ink_for(picture, layers);
  if (overlays.depth_cue) draw_depth_cue(picture, layers, *overlays.depth_cue);
  if (overlays.outline) draw_outline(picture, layers, *overlays.outline);
  if (overlays.scale_bar) draw_scale_bar(picture, bar_of(*overlays.scale_bar, scene, "--scale-bar"), ink);
  if (overlays.axes) draw_axes(picture, scene, ink);
  if (overlays.color_bar && scene.legend) draw_color_bar(picture, *scene.legend, ink);
}

}  // namespace caplet::post
