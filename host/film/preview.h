// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Tone-maps previews.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "film/image.h"

namespace caplet {

/// Returns displayable linear sRGB in 0..1 from linear sRGB of any size. With m the largest
/// component: up to the knee of 1/2 nothing changes; above it m becomes 1 - exp(-(2 m - 1)) / 2, a
/// shoulder of equal slope at the knee that approaches 1. All components scale alike, so hue and
/// saturation stay; only beyond that light goes towards white, by 1 - 1 / (1 + (m - mapped m) / 8),
/// as film and eyes do. Negative and NaN components are 0, infinite ones white.
std::array<float, 3> tone_map(const std::array<float, 3>& rgb);

/// Returns the slope of the displayed value, sRGB's curve of tone_map, for a grey of this
/// luminance, from 12.92 for black down to 0. luminance: 0 or more.
double display_slope(double luminance);

/// Shown is the displayed data window of an image: linear sRGB from 0 to 1. `alpha` is empty where
/// all is opaque; otherwise colours are not multiplied by it.
struct Shown {
  int width = 0, height = 0;
  std::vector<std::array<float, 3>> rgb;
  std::vector<float> alpha;

  bool has_alpha() const { return !alpha.empty(); }
};

/// Returns the image's R G B, converted to sRGB primaries, exposed and tone-mapped. Over a backdrop
/// only the shapes' light is, and the backdrop keeps its brightness. Throws std::logic_error when
/// there are no R G B channels (with a backdrop, A).
Shown shown(const LayeredImage& image);

/// ExposureMeter tells by how many stops a picture is to be brighter: the 95th percentile of the
/// largest component of its light becomes exposure_target. Pixels count by their coverage, where
/// the picture has it, and light that is not finite, or below 2^-40, does not count.
class ExposureMeter {
 public:
  /// Adds an image, or a band of one; it needs the channels that shown() needs.
  void add(const LayeredImage& image);
  /// Returns the stops, at most most_stops up or down, to within a 32nd; 0 if there was no light.
  double stops() const;

 private:
  static constexpr int bins_per_stop = 16, lowest = -40, highest = 40;
  std::array<double, bins_per_stop*(highest - lowest)> weights_{};  // by log2 of the light
};

/// What an automatic exposure makes of the light that few pixels exceed; tone_map shows it as 0.73.
inline constexpr double exposure_target = 0.8;

/// Applies the sRGB transfer: 3 bytes a pixel, 4 where there is alpha.
std::vector<std::uint8_t> bytes_of(const Shown& shown);

/// Returns the bytes of a PNG file of bytes_of. Throws RunError.
std::string png_bytes(const Shown& shown);

/// Returns 3 bytes a pixel; transparent parts lie over black.
std::vector<std::uint8_t> preview_rgb8(const LayeredImage& image);

}  // namespace caplet
