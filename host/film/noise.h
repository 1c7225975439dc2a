// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// How noisy a picture is as a whole, by the variances that it states.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "film/image.h"

namespace caplet {

/// The luminance that noise is relative to is that around a pixel plus this share of the picture's
/// mean: dark places may have more noise for their luminance, much as with sRGB's curve, whose
/// slope is 11.2 at a hundredth of a grey of 0.18 where that is 1.2; 1 / (Y + 0.045) goes from 4.4
/// to 21.
inline constexpr double noise_floor = 0.25;

/// PictureNoise is the noise of a picture: the root of the mean, over the pixels that show
/// something, of the variance over the square of floor and mean luminance, which is that of such
/// pixels at most variance_radius away.
class PictureNoise {
 public:
  /// Adds the next rows of a picture with the channels G, which stands for luminance, A and
  /// variance.G; another image adds nothing.
  void add(const LayeredImage& rows);
  /// Returns the noise of the pixels with coverage or variance, and empty if there are none.
  std::optional<double> relative() const;

 private:
  struct Pixel {
    float luminance = 0, variance = 0;
    bool seen = false;
  };
  std::size_t width_ = 0;
  std::vector<Pixel> pixels_;
};

}  // namespace caplet
