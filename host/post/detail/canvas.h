// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Draws smooth-edged lines, boxes and text on a displayed picture. Pixel (0, 0) is the square from
// (0, 0) to (1, 1), y down.
#pragma once

#include <array>
#include <glm/vec2.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "film/preview.h"

namespace caplet::post {

/// The covered share of each pixel.
class Mask {
 public:
  Mask(int width, int height)
      : width_(width),
        height_(height),
        share_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height)) {}

  int width() const { return width_; }
  int height() const { return height_; }
  float& at(int x, int y) {
    return share_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                  static_cast<std::size_t>(x)];
  }
  const std::vector<float>& shares() const { return share_; }

  /// Draws a line of that width with round ends.
  void line(const glm::dvec2& from, const glm::dvec2& to, double width);
  /// Covers exactly each pixel's share of the box.
  void box(const glm::dvec2& low, const glm::dvec2& high);

 private:
  int width_, height_;
  std::vector<float> share_;
};

/// Paints a share of a pixel, or the mask, in a colour: sRGB from 0 to 1, blended in sRGB.
void paint(Shown& picture, std::size_t pixel, float share, const std::array<float, 3>& srgb);
void paint(Shown& picture, const Mask& mask, const std::array<float, 3>& srgb);

/// Text is in DejaVu Sans. `size`: the height of capitals; `at` is the start of the baseline.
/// Characters that the font lacks become boxes.
double text_width(std::string_view utf8, double size);
void text(Mask& mask, const glm::dvec2& at, std::string_view utf8, double size);

}  // namespace caplet::post
