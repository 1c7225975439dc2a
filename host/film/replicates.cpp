// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "film/replicates.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace caplet {

namespace {

/// Estimate is the sum of the variances of `pixels` pixels.
struct Estimate {
  std::array<double, 3> variance{};
  double pixels = 0;
  void add(const Estimate& other) {
    for (std::size_t c = 0; c < 3; ++c) variance[c] += other.variance[c];
    pixels += other.pixels;
  }
};

/// Returns a - b, or 0 where they differ by no more than their roundings: sums become doubles and
/// are divided, each within 2^-53 of its value, and b is the difference of two of them, of which
/// one is at most n / n2 times b.
double difference(double a, double b, double sum_over_b) {
  const double d = a - b, rounding = 0x1p-51 * (std::abs(a) + sum_over_b * std::abs(b));
  return std::abs(d) <= rounding ? 0 : d;
}

Estimate estimate_of(const Film& film, const std::array<double, 9>& m, std::size_t pixel) {
  const double n = film.samples(pixel), n1 = film.first_replicate_samples(pixel), n2 = n - n1;
  Estimate out;
  if (n1 == 0 || n2 == 0) return out;
  std::array<double, 3> xyz{};
  for (std::size_t c = 0; c < 3; ++c) {
    const double first = film.sum(Layer::variance, c, pixel),
                 all = film.sum(Layer::color, c, pixel);
    xyz[c] = difference(first / n1, (all - first) / n2, n / n2);
  }
  if (xyz == std::array<double, 3>{} && film.sum(Layer::coverage, 0, pixel) == 0) return out;
  out.pixels = 1;
  for (std::size_t c = 0; c < 3; ++c) {
    const double rgb = m[3 * c] * xyz[0] + m[3 * c + 1] * xyz[1] + m[3 * c + 2] * xyz[2];
    out.variance[c] = rgb * rgb * n1 * n2 / (n * n);
  }
  return out;
}

/// Calls add(j) for each j of 0 to count - 1 that is at most variance_radius away from i.
template <class Add>
void for_neighbours(int i, int count, const Add& add) {
  for (int j = std::max(0, i - variance_radius); j <= std::min(count - 1, i + variance_radius); ++j)
    add(static_cast<std::size_t>(j));
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
        out[begin + x][c] = row[x].variance[c] / row[x].pixels;
  }
  return out;
}

}  // namespace caplet
