// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// How noisy a picture is as a whole.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "film/film.h"
#include "scene/backdrop.h"
#include "scene/sampler.h"

namespace caplet {

/// The luminance that noise is relative to is that around a pixel plus this share of the picture's
/// mean: dark places may have more noise for their luminance, much as with sRGB's curve, whose
/// slope is 11.2 at a hundredth of a grey of 0.18 where that is 1.2; 1 / (Y + 0.045) goes from 4.4
/// to 21.
inline constexpr double noise_floor = 0.25;

/// NoiseMeasure is what noise is a share of. For displays the picture is `gain` times as bright.
struct NoiseMeasure {
  NoiseMeasure(NoiseSpace of = NoiseSpace::relative, double times = 1) : space(of), gain(times) {}
  /// For previews of this exposure. One that the picture decides is not known while it is rendered,
  /// and counts as none.
  NoiseMeasure(NoiseSpace of, const PreviewExposure& exposure);
  NoiseSpace space;
  double gain;
};

/// Returns what the standard deviation of a pixel's luminance is divided by: luminance and floor,
/// or one over the slope of previews' tone curve (tone_map and sRGB's curve) for a grey of this
/// luminance, so that noise is a share of the display's range. `luminance`: mean around the pixel;
/// `floor`: noise_floor of the picture's mean.
double noise_unit(const NoiseMeasure& measure, double luminance, double floor);

/// NoisePixel is what the noise of a picture depends on.
struct NoisePixel {
  float luminance = 0, variance = 0;  // of its mean
  bool seen = false;
};

/// Returns the root of the mean, over the pixels that are seen, of the variance over the square of
/// noise_unit, for the mean luminance of such pixels at most variance_radius away. Empty if they
/// have no light. `pixels`: row by row.
std::optional<double> noise_of(const std::vector<NoisePixel>& pixels, int width,
                               const NoiseMeasure& measure = {});

/// PictureNoise is the noise of a film, by what the replicates of each pixel say themselves: their
/// mean over a picture is true, while the layer `variance` shares them with neighbours that may be
/// darker.
class PictureNoise {
 public:
  /// Adds rows [first, first + count) of a film; nothing if its layers have no variance. Rows that
  /// do not follow those that it has are not added: a picture may be developed twice.
  void add(const Film& film, int first, int count);
  /// Returns the noise of the pixels that have an estimate; empty if there are none.
  std::optional<double> in(const NoiseMeasure& measure) const {
    return noise_of(pixels_, width_, measure);
  }

 private:
  int width_ = 0, next_row_ = 0;  // of the whole picture
  std::vector<NoisePixel> pixels_;
};

}  // namespace caplet
