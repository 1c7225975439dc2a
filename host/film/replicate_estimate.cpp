// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "film/replicate_estimate.h"

#include <cmath>

namespace caplet {

namespace {

/// Returns a - b, or 0 where they differ by no more than their roundings: sums become doubles and
/// are divided, each within 2^-53 of its value, and b is the difference of two of them, of which
/// one is at most n / n2 times b.
double difference(double a, double b, double sum_over_b) {
  const double d = a - b, rounding = 0x1p-51 * (std::abs(a) + sum_over_b * std::abs(b));
  return std::abs(d) <= rounding ? 0 : d;
}

}  // namespace

bool replicates_differ(const Film& film, std::size_t pixel, std::array<double, 3>& xyz) {
  const double n = film.samples(pixel), n1 = film.first_replicate_samples(pixel), n2 = n - n1;
  xyz = {};
  if (n1 == 0 || n2 == 0) return false;
  for (std::size_t c = 0; c < 3; ++c) {
    const double first = film.sum(Layer::variance, c, pixel),
                 all = film.sum(Layer::color, c, pixel);
    xyz[c] = difference(first / n1, (all - first) / n2, n / n2);
  }
  return xyz != std::array<double, 3>{} || film.sum(Layer::coverage, 0, pixel) != 0;
}

double sample_variance_factor(const Film& film, std::size_t pixel) {
  const double n = film.samples(pixel), n1 = film.first_replicate_samples(pixel), n2 = n - n1;
  return n1 * n2 / n;
}

}  // namespace caplet
