// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This file tells what the two replicates of a pixel say about its variance.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "film/film.h"

namespace caplet {

/// Pixels this far away, in x and in y, share their estimates of the variance: 49 of one degree of
/// freedom each make a confidence interval hold what it should (docs/decisions/0033).
inline constexpr int variance_radius = 3;

/// Returns whether a pixel has an estimate: samples in both replicates that something was hit in,
/// or whose replicates differ. `difference`: the first replicate's mean of CIE XYZ minus the
/// second's, 0 where they differ by no more than their roundings.
bool replicates_differ(const Film& film, std::size_t pixel, std::array<double, 3>& difference);
/// Returns what the square of that difference is multiplied by to have the variance of one sample
/// as its expectation, where samples are independent: n1 n2 / n.
double sample_variance_factor(const Film& film, std::size_t pixel);

/// Calls add(j) for each j of 0 to count - 1 that is at most variance_radius away from i.
template <class Add>
void for_neighbours(int i, int count, const Add& add) {
  for (int j = std::max(0, i - variance_radius); j <= std::min(count - 1, i + variance_radius); ++j)
    add(static_cast<std::size_t>(j));
}

}  // namespace caplet
