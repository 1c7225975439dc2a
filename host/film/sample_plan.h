// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Decides how many samples each pixel of a film still needs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "film/film.h"
#include "film/noise.h"
#include "shared/records.h"

namespace caplet {

/// NoiseTarget says when a picture has enough samples: when its noise by `measure` is
/// at most `noise`. With noise 0 each pixel gets `most` samples.
struct NoiseTarget {
  double noise = 0;
  std::uint32_t least = 16, most = most_noise_samples;  // samples of a pixel, least <= most
  NoiseMeasure measure = {};
};

/// PixelSamples is the next `count` samples of some pixels.
struct PixelSamples {
  std::uint32_t count = 0;
  /// Tile by tile of 8 x 8. A pixel that gets several times `count` has as many records, one after
  /// the other, of samples that follow each other.
  std::vector<PixelRecord> pixels;
};

inline bool is_same_pixel(const PixelRecord& a, const PixelRecord& b) {
  return a.x == b.x && a.y == b.y;
}

/// Returns the next `count` samples of each pixel of a film of samples `begin`, begin + 1, ...
PixelSamples next_samples(const Film& film, std::uint32_t begin, std::uint32_t count);

/// SamplePlan is what to render before looking again.
struct SamplePlan {
  std::vector<PixelSamples> samples;  // by count; no pixel is in two of them
  double paths = 0;                   // of these samples
  double paths_left = 0;              // of these, and of those that will probably follow
  double noise = 0;                   // of the film so far

  bool empty() const { return samples.empty(); }
  /// Cuts off about so many paths, of one pixel at least, with all samples of their pixels.
  std::vector<PixelSamples> take(double paths_wanted);
};

/// SampledPixels is what plans know of a film: how many samples its pixels have, and what their
/// replicates say. It takes 28 bytes a pixel.
class SampledPixels {
 public:
  /// Of a film that has no samples yet.
  explicit SampledPixels(const FilmLayout& layout);
  /// Looks at all pixels of a film, or of some of its rows, again.
  void look_at(const Film& rows);

  const Window& window() const { return window_; }
  std::size_t size() const { return samples_.size(); }
  std::uint32_t samples(std::size_t pixel) const { return samples_[pixel]; }
  /// Returns their mean over the pixels; 0 without pixels.
  double mean_samples() const;

  /// OwnSum is the sum, over some pixels with an estimate, of the variance of a sample of
  /// luminance, and of luminance.
  struct OwnSum {
    double variance = 0, luminance = 0, pixels = 0;
    void add(const OwnSum& other) {
      variance += other.variance;
      luminance += other.luminance;
      pixels += other.pixels;
    }
  };
  /// Returns that of each pixel alone; none of films without the layer `variance`.
  const std::vector<OwnSum>& own() const { return own_; }

 private:
  Window window_;
  std::vector<std::uint32_t> samples_;
  std::vector<OwnSum> own_;
};

/// Returns the samples that bring a film of samples `begin`, begin + 1, ... of each pixel closer to
/// the target. The film has the layer `variance` unless the target's noise is 0.
///
/// The fewest samples with which a picture has a noise are in proportion to the root of the
/// variance of a sample over noise_unit, pixel by pixel (Neyman, "On the two different
/// aspects of the representative method", 1934).
///
/// A pixel is judged by its neighbours alone: the mean of the variances of a sample, and of the
/// luminances, of the pixels at most variance_radius away that have an estimate
/// (variances_of_means). Since a pixel's own samples have no part in it, how many they become does
/// not depend on their values, and their mean is not biased; what is left is that its neighbours'
/// numbers of samples depend on it, which their estimates' expectations do not. The picture's noise
/// is by the mean of the pixels' own estimates, which therefore says what is true, plus one
/// standard error of it: else renders would end where rare bright samples happen to be missing.
///
/// A pixel about doubles its samples at a time.
SamplePlan plan_samples(const SampledPixels& pixels, std::uint32_t begin,
                        const NoiseTarget& target);
SamplePlan plan_samples(const Film& film, std::uint32_t begin, const NoiseTarget& target);

}  // namespace caplet
