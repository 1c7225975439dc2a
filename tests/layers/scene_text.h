// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Pictures of scenes written as text, the program's own way: import, lower, render, develop.
#pragma once

#include <cmath>
#include <fstream>
#include <functional>
#include <glm/vec3.hpp>
#include <string>

#include "render_scene.h"
#include "support/data.h"

namespace caplet::test {

inline Rendered render_text(const std::string& text, int samples_per_pixel,
                            const std::function<void(Scene&)>& change = {},
                            const RenderOptions& options = {}) {
  const auto file = temporary_folder() / "scene.pbrt";
  std::ofstream(file) << text;
  return render_file(file, samples_per_pixel, change, options);
}

inline RenderOptions every_layer() {
  RenderOptions options;
  options.layers = Layers::every();
  return options;
}

/// No wider than the rounding of raster coordinates: all camera rays of a pixel go through its
/// middle.
inline PixelFilter point_filter() {
  return {.kind = PixelFilter::Kind::box, .radius_x = 1e-7, .radius_y = 1e-7};
}

inline double at(const LayeredImage& image, const std::string& name, std::size_t pixel) {
  return double{channel(image, name).floats.at(pixel)};
}

/// Three channels of a layer: ("N", "XYZ").
inline glm::dvec3 at3(const LayeredImage& image, const std::string& layer, const std::string& axes,
                      std::size_t pixel) {
  const std::string prefix = layer.empty() ? "" : layer + ".";
  return {at(image, prefix + axes[0], pixel), at(image, prefix + axes[1], pixel),
          at(image, prefix + axes[2], pixel)};
}

inline double mean(const Channel& channel) {
  double sum = 0;
  for (const float v : channel.floats) sum += double{v};
  return sum / static_cast<double>(channel.floats.size());
}

}  // namespace caplet::test
