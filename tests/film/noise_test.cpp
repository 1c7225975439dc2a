// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "film/noise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "film_sums.h"

namespace caplet::test {
namespace {

std::vector<NoisePixel> pixels_of(const std::vector<float>& luminances,
                                  const std::vector<float>& variances) {
  std::vector<NoisePixel> out;
  for (std::size_t i = 0; i < luminances.size(); ++i)
    out.push_back({luminances[i], variances[i], true});
  return out;
}

// 2 x 2 pixels see each other: all are relative to their mean, 4, and a quarter of it.
TEST(PictureNoise, IsTheRootOfTheMeanVarianceOverTheLuminance) {
  EXPECT_NEAR(noise_of(pixels_of({1, 2, 3, 10}, {0.01f, 0.02f, 0.03f, 0.3f}), 2).value(),
              std::sqrt(0.09) / 5, 1e-8);
}

// Luminance is that around a pixel, at most 3 away; the floor is that of the picture, 0.25 * 2.5.
TEST(PictureNoise, IsRelativeToTheLuminanceAroundAPixel) {
  const std::vector<float> steps{1, 1, 1, 1, 4, 4, 4, 4};
  EXPECT_NEAR(noise_of(pixels_of(steps, {0.5f, 0, 0, 0, 0, 0, 0, 0.5f}), 8).value(),
              std::sqrt((0.5 / (1.625 * 1.625) + 0.5 / (4.625 * 4.625)) / 8), 1e-8);
  double sum = 0;
  for (const double mean : {1.0, 8.0 / 5, 12.0 / 6, 16.0 / 7, 19.0 / 7, 18.0 / 6, 17.0 / 5, 4.0})
    sum += 0.0625 / (mean + 0.625) / (mean + 0.625);
  EXPECT_NEAR(noise_of(pixels_of(steps, std::vector<float>(8, 0.0625f)), 1).value(),
              std::sqrt(sum / 8), 1e-7);
}

TEST(PictureNoise, IsThereForPicturesWithLight) {
  EXPECT_FALSE(noise_of({}, 0));
  EXPECT_FALSE(noise_of(pixels_of({0, 0}, {1, 1}), 2)) << "of black";
  EXPECT_NEAR(noise_of(pixels_of({0, 0, 4, 0}, {1, 1, 0, 0}), 2).value(), std::sqrt(2.0 / 4) / 1.25,
              1e-7);
}

// In the display's space the unit is one over the slope of what a grey is shown as. Expected slopes
// are differences of the tone curve of docs/output.md, with sRGB's encoding.
double shown(double grey) {
  const double mapped = grey <= 0.5 ? grey : 1 - std::exp(-(2 * grey - 1)) / 2;
  return mapped <= 0.0031308 ? 12.92 * mapped : 1.055 * std::pow(mapped, 1 / 2.4) - 0.055;
}

TEST(PictureNoise, OfADisplayIsAShareOfItsRange) {
  for (const double grey : {0.001, 0.002, 0.01, 0.18, 0.45, 0.6, 1.0, 3.0}) {
    const double step = 1e-5 * grey;
    const double slope = (shown(grey + step) - shown(grey - step)) / (2 * step);
    EXPECT_NEAR(1 / noise_unit(NoiseSpace::display, grey, 0.1), slope, 1e-6 * slope) << grey;
    EXPECT_EQ(noise_unit(NoiseSpace::relative, grey, 0.1), grey + 0.1);
  }
  // A picture at two stops up has the noise of one that is four times as bright.
  const NoiseMeasure brighter(NoiseSpace::display, PreviewExposure{2, false});
  for (const double grey : {0.001, 0.05, 0.18, 0.7})
    EXPECT_NEAR(noise_unit(brighter, grey, 0.1), noise_unit(NoiseSpace::display, 4 * grey, 0.1) / 4,
                1e-12);
  EXPECT_EQ(NoiseMeasure(NoiseSpace::display, PreviewExposure{2, true}).gain, 1);
  EXPECT_EQ(noise_unit({NoiseSpace::relative, 4.0}, 0.5, 0.1), 0.6);
  EXPECT_NEAR(noise_unit(NoiseSpace::display, -0.5, 0.1), 1 / 12.92, 1e-12);
  EXPECT_EQ(noise_unit(NoiseSpace::relative, -0.5, 0.1), 0.1);
  const double slope = 1.055 / 2.4 * std::pow(0.25, 1 / 2.4 - 1);
  EXPECT_NEAR(noise_of(pixels_of(std::vector<float>(8, 0.25f), {0.01f, 0, 0, 0, 0, 0, 0, 0.03f}), 4,
                       NoiseSpace::display)
                  .value(),
              slope * std::sqrt(0.04 / 8), 1e-7);
}

// What is not seen does not count, whatever its numbers are.
TEST(PictureNoise, IsThatOfWhatIsSeen) {
  std::vector<NoisePixel> pixels = pixels_of({1, 1, 100, 100}, {0.25f, 0.25f, 7, 7});
  pixels[2].seen = pixels[3].seen = false;
  EXPECT_NEAR(noise_of(pixels, 2).value(), 0.5 / 1.25, 1e-7);
}

/// A film of 2 x 4 pixels with 8 samples each, of which replicates of half the samples have mean
/// luminances y + d and y - d: the variance of their mean is d^2.
Film film_of(const std::vector<double>& y, const std::vector<double>& d, Layers layers) {
  FilmLayout layout;
  layout.width = layout.height = 20;
  layout.window = {3, 5, 2, 4};
  layout.layers = layers;
  Film film(layout);
  for (std::size_t i = 0; i < y.size(); ++i) {
    film.words()[i * layout.words_per_pixel()] = std::uint64_t{4} << 32 | 8;
    set_sum(film, Layer::color, 1, i, 8 * y[i]);
    if (!layers.has(Layer::variance)) continue;
    set_sum(film, Layer::variance, 1, i, 4 * (y[i] + d[i]));
    set_sum(film, Layer::coverage, 0, i, y[i] > 0 ? 8 : 0);
  }
  return film;
}

// The bright pixel at the corner varies, and those beside it are dark: its variance is over its own
// surroundings alone. The pixels without light or hits do not count.
TEST(PictureNoise, OfAFilmIsByEachPixelsOwnReplicates) {
  const Layers layers = Layers::none().with(Layer::variance);
  const Film film = film_of({48, 1, 1, 1, 1, 1, 0, 0}, {3, 0, 0, 0, 0, 0.5, 0, 0}, layers);
  PictureNoise noise;
  EXPECT_FALSE(noise.in(NoiseSpace::relative));
  noise.add(film, 0, 4);
  // Rows 0 to 3 see each other: the luminance around all six is 53 / 6.
  EXPECT_NEAR(noise.in(NoiseSpace::relative).value(), std::sqrt((9 + 0.25) / 6) / (1.25 * 53 / 6),
              1e-7);

  PictureNoise in_parts;
  in_parts.add(film.rows(0, 3), 0, 2);  // with a row below, which is of the next part
  in_parts.add(film.rows(1, 3), 1, 2);
  EXPECT_EQ(in_parts.in(NoiseSpace::relative), noise.in(NoiseSpace::relative));
  in_parts.add(film, 0, 4);
  EXPECT_EQ(in_parts.in(NoiseSpace::relative), noise.in(NoiseSpace::relative))
      << "the same rows again";

  PictureNoise none;
  none.add(film_of({1, 1, 1, 1, 1, 1, 1, 1}, {}, Layers::none()), 0, 4);
  EXPECT_FALSE(none.in(NoiseSpace::relative));
}

}  // namespace
}  // namespace caplet::test
