// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include <algorithm>
#include <glm/matrix.hpp>

#include "post/detail/parts.h"
#include "scene/camera.h"

namespace caplet::post {

void draw_labels(Shown& picture, const LayeredImage& layers, const Scene& scene,
                 const std::vector<Label>& labels, const std::array<float, 3>& ink) {
  const double size = text_size(picture), padding = 0.4 * size;
  const glm::dmat4 camera_from_world = glm::inverse(scene.view.camera.world_from_camera);
  const float paper = 1 - ink[0];
  for (const Label& label : labels) {
    const auto raster = project(scene.view.camera, scene.view.film,
                                glm::dvec3(camera_from_world * glm::dvec4(label.at, 1)));
    if (!raster) continue;
    const glm::dvec2 at = *raster - glm::dvec2(layers.x, layers.y);
    if (!(at.x >= 0 && at.y >= 0 && at.x < picture.width && at.y < picture.height)) continue;
    // The words are at the upper right of the point, or where there is room.
    const double wide = text_width(label.words, size) + 2 * padding, tall = size + 2 * padding;
    const double left = at.x + size + wide <= picture.width ? at.x + size : at.x - size - wide,
                 top = at.y - size - tall >= 0 ? at.y - size - tall : at.y + size;
    Mask box(picture.width, picture.height), marks(picture.width, picture.height);
    box.box({left, top}, {left + wide, top + tall});
    paint(picture, box, {paper, paper, paper});
    const glm::dvec2 corner(left > at.x ? left : left + wide, top < at.y ? top + tall : top);
    marks.line(at, corner, std::max(1.0, 0.12 * size));
    marks.line(at, at, 0.5 * size);
    text(marks, {left + padding, top + padding + size}, label.words, size);
    paint(picture, marks, ink);
  }
}

}  // namespace caplet::post
