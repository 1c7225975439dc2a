// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Estimates the variance of each pixel's mean from the film's two replicates.
#pragma once

#include <array>
#include <vector>

#include "film/film.h"
#include "film/replicate_estimate.h"

namespace caplet {

/// Returns the variance of each pixel's mean of R G B = `rgb_from_xyz` XYZ, row by row.
///
/// The samples of even and of odd number, n1 and n2 of n, are independent estimates a and b of the
/// same mean, so that (a - b)^2 n1 n2 / n^2 has the variance of all samples' mean as its
/// expectation, however the sampler stratifies each of them. That is one degree of freedom. It
/// is averaged over the pixels at most `variance_radius` away in x and in y that have an estimate:
/// those with samples in both replicates that something was hit in, or whose replicates differ.
/// Other pixels have variance 0.
std::vector<std::array<double, 3>> variances_of_means(const Film& film,
                                                      const std::array<double, 9>& rgb_from_xyz);

}  // namespace caplet
