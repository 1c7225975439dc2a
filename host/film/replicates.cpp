// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "film/replicates.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "film/detail/sums_around.h"
#include "film/replicate_estimate.h"

namespace caplet {

namespace {

/// Estimate is the sum of the variances of the means of `pixels` pixels.
struct Estimate {
  std::array<double, 3> variance{};
  double pixels = 0;
  void add(const Estimate& other) {
    for (std::size_t c = 0; c < 3; ++c) variance[c] += other.variance[c];
    pixels += other.pixels;
  }
};

Estimate estimate_of(const Film& film, const std::array<double, 9>& m, std::size_t pixel) {
  Estimate out;
  std::array<double, 3> xyz{};
  if (!replicates_differ(film, pixel, xyz)) return out;
  out.pixels = 1;
  for (std::size_t c = 0; c < 3; ++c) {
    const double rgb = m[3 * c] * xyz[0] + m[3 * c + 1] * xyz[1] + m[3 * c + 2] * xyz[2];
    out.variance[c] = rgb * rgb * sample_variance_factor(film, pixel) / film.samples(pixel);
  }
  return out;
}

}  // namespace

// Pixels share the variances of their means, not those of their samples over their own numbers of
// samples: a plan gives the brightest of a few pixels fewer samples than those around it
// (sample_plan.cpp), so that the sum of the stated variances would be too small.
std::vector<std::array<double, 3>> variances_of_means(const Film& film,
                                                      const std::array<double, 9>& rgb_from_xyz) {
  const Window& window = film.layout().window;
  std::vector<Estimate> own(window.pixels());
  tbb::parallel_for(std::size_t{0}, own.size(), [&](std::size_t pixel) {
    own[pixel] = estimate_of(film, rgb_from_xyz, pixel);
  });
  std::vector<Estimate> around = sums_around(own, window.width, window.height);
  std::vector<std::array<double, 3>> out(window.pixels());
  for (std::size_t pixel = 0; pixel < out.size(); ++pixel) {
    if (own[pixel].pixels == 0) continue;
    around[pixel].add(own[pixel]);
    for (std::size_t c = 0; c < 3; ++c)
      out[pixel][c] = around[pixel].variance[c] / around[pixel].pixels;
  }
  return out;
}

}  // namespace caplet
