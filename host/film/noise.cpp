// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "film/noise.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "film/detail/sums_around.h"
#include "film/preview.h"

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

NoisePixel pixel_of(const Film& film, std::size_t pixel) {
  std::array<double, 3> xyz{};
  if (!replicates_differ(film, pixel, xyz)) return {};
  const double n = film.samples(pixel);
  return {static_cast<float>(film.sum(Layer::color, 1, pixel) / n),
          static_cast<float>(xyz[1] * xyz[1] * sample_variance_factor(film, pixel) / n), true};
}

}  // namespace

NoiseMeasure::NoiseMeasure(NoiseSpace of, const PreviewExposure& exposure)
    : NoiseMeasure(of, exposure.is_automatic ? 1 : std::exp2(exposure.stops)) {}

double noise_unit(const NoiseMeasure& measure, double luminance, double floor) {
  const double seen = std::max(0.0, luminance);
  return measure.space == NoiseSpace::display
             ? 1 / (measure.gain * display_slope(measure.gain * seen))
             : seen + floor;
}

std::optional<double> noise_of(const std::vector<NoisePixel>& pixels, int width,
                               const NoiseMeasure& measure) {
  const auto columns = static_cast<std::size_t>(std::max(1, width));
  std::vector<Luminance> own(pixels.size());
  Luminance all;
  for (std::size_t i = 0; i < own.size(); ++i) {
    if (pixels[i].seen) own[i] = {double{pixels[i].luminance}, 1};
    all.add(own[i]);
  }
  const double floor = noise_floor * all.sum / all.pixels;
  if (!(floor > 0)) return {};
  std::vector<Luminance> around =
      sums_around(own, width, static_cast<int>(pixels.size() / columns));
  double sum = 0;
  for (std::size_t i = 0; i < own.size(); ++i) {
    if (!pixels[i].seen) continue;
    around[i].add(own[i]);
    const double unit = noise_unit(measure, around[i].sum / around[i].pixels, floor);
    sum += double{pixels[i].variance} / (unit * unit);
  }
  return std::sqrt(sum / all.pixels);
}

void PictureNoise::add(const Film& film, int first, int count) {
  const FilmLayout& layout = film.layout();
  if (!layout.layers.has(Layer::variance)) return;
  const int row = layout.window.y + first;
  if (!pixels_.empty() && row != next_row_) return;
  width_ = layout.window.width;
  next_row_ = row + count;
  const auto columns = static_cast<std::size_t>(width_),
             begin = static_cast<std::size_t>(first) * columns, size = pixels_.size();
  pixels_.resize(size + static_cast<std::size_t>(count) * columns);
  tbb::parallel_for(size, pixels_.size(), [&](std::size_t pixel) {
    pixels_[pixel] = pixel_of(film, begin + pixel - size);
  });
}

}  // namespace caplet
