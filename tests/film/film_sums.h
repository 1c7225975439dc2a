// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Sums of a film by another way than the device's: digit by digit.
#pragma once

#include <cmath>
#include <cstdint>

#include "film/film.h"

namespace caplet::test {

/// Sets component `c` of a layer of a pixel to `value`, towards zero to whole units.
inline void set_sum(Film& film, Layer layer, std::size_t c, std::size_t pixel, double value) {
  const FilmLayout& layout = film.layout();
  const LayerRow& row = row_of(layer);
  const auto words = static_cast<std::size_t>(row.words);
  std::uint64_t* sum =
      &film.words()[pixel * layout.words_per_pixel() + layout.first_word(layer) + c * words];
  double left = std::floor(
      std::ldexp(std::abs(value), -row.unit(layout.color_exponent, layout.length_exponent)));
  for (std::size_t w = 0; w < words; ++w) {
    const double next = std::floor(std::ldexp(left, -64));
    sum[w] = static_cast<std::uint64_t>(left - std::ldexp(next, 64));
    left = next;
  }
  if (value >= 0) return;
  bool carry = true;
  for (std::size_t w = 0; w < words; ++w) {
    sum[w] = ~sum[w] + (carry ? 1 : 0);
    carry = carry && sum[w] == 0;
  }
}

}  // namespace caplet::test
