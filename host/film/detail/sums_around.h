// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <tbb/parallel_for.h>

#include <cstddef>
#include <vector>

#include "film/replicate_estimate.h"

namespace caplet {

/// Returns, for each pixel of a picture, the sum of the values of all other pixels at most
/// variance_radius away in x and in y. T{} is a sum of none, and T has add(const T&). The order of
/// additions, and so the result, does not depend on the number of threads.
template <class T>
std::vector<T> sums_around(const std::vector<T>& values, int width, int height) {
  const auto columns = static_cast<std::size_t>(width);
  std::vector<T> rows(values.size()), out(values.size());
  tbb::parallel_for(0, height, [&](int y) {
    const std::size_t row = static_cast<std::size_t>(y) * columns;
    for (int x = 0; x < width; ++x) {
      const std::size_t pixel = row + static_cast<std::size_t>(x);
      for_neighbours(x, width, [&](std::size_t other) {
        rows[pixel].add(values[row + other]);
        if (row + other != pixel) out[pixel].add(values[row + other]);
      });
    }
  });
  tbb::parallel_for(0, height, [&](int y) {
    const std::size_t row = static_cast<std::size_t>(y) * columns;
    for_neighbours(y, height, [&](std::size_t other) {
      if (other * columns == row) return;
      for (std::size_t x = 0; x < columns; ++x) out[row + x].add(rows[other * columns + x]);
    });
  });
  return out;
}

}  // namespace caplet
