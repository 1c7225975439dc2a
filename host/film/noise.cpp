// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "film/noise.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "film/replicate_estimate.h"

namespace caplet {

namespace {

/// Luminance is a sum over some pixels.
struct Luminance {
  double sum = 0, pixels = 0;
  void add(const Luminance& other) {
    sum += other.sum;
    pixels += other.pixels;
  }
};

}  // namespace

void PictureNoise::add(const LayeredImage& rows) {
  const Channel *g = rows.find("G"), *a = rows.find("A"), *variance = rows.find("variance.G");
  if (!g || !a || !variance) return;
  width_ = static_cast<std::size_t>(rows.data_width);
  for (std::size_t i = 0; i < g->floats.size(); ++i)
    pixels_.push_back(
        {g->floats[i], variance->floats[i], a->floats[i] > 0 || variance->floats[i] > 0});
}

std::optional<double> PictureNoise::relative() const {
  Luminance all;
  std::vector<Luminance> rows(pixels_.size());
  const auto of = [this](std::size_t pixel) {
    return pixels_[pixel].seen ? Luminance{double{pixels_[pixel].luminance}, 1} : Luminance{};
  };
  const std::size_t height = width_ > 0 ? pixels_.size() / width_ : 0;
  for (std::size_t y = 0; y < height; ++y)
    for (std::size_t x = 0; x < width_; ++x) {
      all.add(of(y * width_ + x));
      for_neighbours(static_cast<int>(x), static_cast<int>(width_),
                     [&](std::size_t other) { rows[y * width_ + x].add(of(y * width_ + other)); });
    }
  const double floor = noise_floor * all.sum / all.pixels;
  if (!(floor > 0)) return {};
  double sum = 0;
  for (std::size_t y = 0; y < height; ++y)
    for (std::size_t x = 0; x < width_; ++x) {
      const Pixel& pixel = pixels_[y * width_ + x];
      if (!pixel.seen) continue;
      Luminance around;
      for_neighbours(static_cast<int>(y), static_cast<int>(height),
                     [&](std::size_t other) { around.add(rows[other * width_ + x]); });
      const double relative_to = std::max(0.0, around.sum / around.pixels) + floor;
      sum += double{pixel.variance} / (relative_to * relative_to);
    }
  return std::sqrt(sum / all.pixels);
}

}  // namespace caplet
