// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// How noisy a picture is as a whole, by the variances that it states.
#pragma once

#include <cstddef>
#include <optional>

#include "film/image.h"

namespace caplet {

/// Adds up the rows of a picture.
class PictureNoise {
 public:
  /// Adds the pixels of an image with the channels G and variance.G; another image adds nothing.
  void add(const LayeredImage& rows);
  /// Returns the root of the mean variance of G over the mean of G. It is empty if no variance was
  /// added, or the mean is not positive.
  std::optional<double> relative() const;

 private:
  double sum_ = 0, variance_ = 0;
  std::size_t count_ = 0;
};

}  // namespace caplet
