// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Compares two renders of a scene by their means and variances: the pixelwise Z-test and block
// means.
#pragma once

#include <string>
#include <vector>

namespace caplet::test {

/// RGB, row-major, 3 floats a pixel; `variance`, of each pixel's mean, may be empty.
struct Picture {
  int width = 0, height = 0;
  std::vector<float> rgb, variance;
};

struct Figures {
  double mean = 0;    // mean of ours / mean of theirs - 1
  double blocks = 0;  // root mean square relative difference of 8x8 block means, relative to the
                      // block's grey, at least 2 % of the image's
  double z_mean = 0, z_sd = 0;  // of (ours - theirs) / sqrt(both variances), green
  double beyond_3 = 0;          // share of pixels with |z| > 3
  std::size_t pixels = 0;       // with a variance
};

/// Throws std::logic_error when the sizes differ.
Figures compare(const Picture& ours, const Picture& theirs);

/// Mean relative squared error over pixels and channels, (ours - theirs)^2 / (theirs^2 + 1e-2),
/// without the highest 1 %.
double clipped_relative_squared_error(const Picture& ours, const Picture& theirs);

}  // namespace caplet::test
