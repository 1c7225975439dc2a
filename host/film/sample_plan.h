// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Decides how many samples each pixel of a film still needs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "film/film.h"
#include "shared/records.h"

namespace caplet {

/// NoiseTarget says when a picture has enough samples: when its noise (film/noise.h) is at most
/// `noise`. With noise 0 each pixel gets `most` samples.
struct NoiseTarget {
  double noise = 0;
  std::uint32_t least = 16, most = 1u << 14;  // samples of a pixel, least <= most
};

/// PixelSamples is the next `count` samples of some pixels.
struct PixelSamples {
  std::uint32_t count = 0;
  std::vector<PixelRecord> pixels;  // tile by tile of 8 x 8, each at most once
};

/// Returns the next `count` samples of each pixel of a film of samples `begin`, begin + 1, ...
PixelSamples next_samples(const Film& film, std::uint32_t begin, std::uint32_t count);

/// SamplePlan is what to render before looking again.
struct SamplePlan {
  std::vector<PixelSamples> samples;  // by count; no pixel is in two of them
  double paths = 0;                   // of these samples
  double paths_left = 0;              // of these, and of those that will probably follow
  double noise = 0;                   // of the film so far

  bool empty() const { return samples.empty(); }
  /// Cuts off about so many paths, of one pixel at least.
  std::vector<PixelSamples> take(double paths_wanted);
};

/// Returns the samples that bring a film of samples `begin`, begin + 1, ... of each pixel closer to
/// the target. The film has the layer `variance` unless the target's noise is 0.
///
/// The fewest samples with which a picture has a noise are in proportion to the root of the
/// variance of a sample over luminance and floor, pixel by pixel (Neyman, "On the two different
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
SamplePlan plan_samples(const Film& film, std::uint32_t begin, const NoiseTarget& target);

}  // namespace caplet
