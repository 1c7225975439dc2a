// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "film/noise.h"

#include <cmath>
#include <numeric>

namespace caplet {

void PictureNoise::add(const LayeredImage& rows) {
  const Channel *g = rows.find("G"), *variance = rows.find("variance.G");
  if (!g || !variance) return;
  sum_ = std::accumulate(g->floats.begin(), g->floats.end(), sum_);
  variance_ = std::accumulate(variance->floats.begin(), variance->floats.end(), variance_);
  count_ += g->floats.size();
}

std::optional<double> PictureNoise::relative() const {
  if (count_ == 0 || !(sum_ > 0)) return {};
  const auto count = static_cast<double>(count_);
  return std::sqrt(variance_ / count) / (sum_ / count);
}

}  // namespace caplet
