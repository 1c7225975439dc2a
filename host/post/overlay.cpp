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

void check(const Overlays& overlays, const Sight& sight, const std::string& flags) {
  if (overlays.scale_bar) bar_of(*overlays.scale_bar, sight, flags + "scale-bar");
  if (overlays.color_bar && !sight.scene.legend)
    throw InputError(SourceLocation{flags + "color-bar"},
                     "the scene's colours have no legend: those of neurons, fibres and molecules "
                     "have one, but for single colours and fibres each of its own");
}

void draw(Shown& picture, const LayeredImage& layers, const Sight& sight,
          const Overlays& overlays) {
  const std::array<float, 3> ink = ink_for(picture, layers);
  if (overlays.depth_cue) draw_depth_cue(picture, layers, *overlays.depth_cue);
  if (overlays.outline) draw_outline(picture, layers, *overlays.outline, sight.joined);
  if (overlays.scale_bar)
    draw_scale_bar(picture, bar_of(*overlays.scale_bar, sight, "scale-bar"), ink);
  if (overlays.axes) draw_axes(picture, sight.scene, ink);
  draw_labels(picture, layers, sight.scene, overlays.labels, ink);
  if (!overlays.color_bar || !sight.scene.legend) return;
  const Legend& legend = *sight.scene.legend;
  if (legend.of_directions)
    draw_directions(picture, sight.scene, ink);
  else if (!legend.names.empty())
    draw_names(picture, legend, ink);
  else
    draw_color_bar(picture, legend, ink);
}

}  // namespace caplet::post
