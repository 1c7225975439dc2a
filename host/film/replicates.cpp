// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "film/replicates.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "film/replicate_estimate.h"

namespace caplet {

namespace {

/// Estimate is the sum of the variances of a sample of `pixels` pixels.
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
    out.variance[c] = rgb * rgb * sample_variance_factor(film, pixel);
  }
  return out;
}

}  // namespace

std::vector<std::array<double, 3>> variances_of_means(const Film& film,
                                                      const std::array<double, 9>& rgb_from_xyz) {
  const Window& window = film.layout().window;
  const auto width = static_cast<std::size_t>(window.width);
  std::vector<Estimate> along_rows(window.pixels());
  std::vector<bool> has_one(window.pixels());
  std::vector<Estimate> row(width);
  for (std::size_t begin = 0; begin < along_rows.size(); begin += width) {
    for (std::size_t x = 0; x < width; ++x) {
      row[x] = estimate_of(film, rgb_from_xyz, begin + x);
      has_one[begin + x] = row[x].pixels > 0;
    }
    for (int x = 0; x < window.width; ++x)
      for_neighbours(x, window.width, [&](std::size_t other) {
        along_rows[begin + static_cast<std::size_t>(x)].add(row[other]);
      });
  }
  std::vector<std::array<double, 3>> out(window.pixels());
  for (int y = 0; y < window.height; ++y) {
    row.assign(width, {});
    for_neighbours(y, window.height, [&](std::size_t other) {
      for (std::size_t x = 0; x < width; ++x) row[x].add(along_rows[other * width + x]);
    });
    const std::size_t begin = static_cast<std::size_t>(y) * width;
    for (std::size_t x = 0; x < width; ++x)
      for (std::size_t c = 0; c < 3 && has_one[begin + x]; ++c)
        out[begin + x][c] =
            row[x].variance[c] / (row[x].pixels * static_cast<double>(film.samples(begin + x)));
  }
  return out;
}

}  // namespace caplet
