// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Film sums to layers, against numbers worked out by hand.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "film/chromaticities.h"
#include "film/develop.h"
#include "lower/spectrum.h"

namespace caplet {
namespace {

ParamsRecord window(uint width, uint height) {
  ParamsRecord params{};
  params.width = 10;
  params.height = 6;
  params.crop_x = 3;
  params.crop_y = 2;
  params.crop_width = width;
  params.crop_height = height;
  return params;
}

FilmRecord nothing() {
  FilmRecord record{};
  record.object = record.primitive = CAPLET_NONE;
  return record;
}

/// XYZ of linear sRGB as the stages make it.
std::array<double, 3> xyz_of_srgb(double r, double g, double b) {
  const std::array<double, 9> m = xyz_from_rgb(ColorSpace::srgb);
  return {m[0] * r + m[1] * g + m[2] * b, m[3] * r + m[4] * g + m[5] * b, m[6] * r + m[7] * g + m[8] * b};
}

FilmRecord with_samples(std::initializer_list<std::array<double, 3>> rgb_samples) {
  FilmRecord record = nothing();
  std::array<double, 3> xyz{}, squares{};
  for (const auto& rgb : rgb_samples) {
    const auto v = xyz_of_srgb(rgb[0], rgb[1], rgb[2]);
    for (std::size_t c = 0; c < 3; ++c) {
      xyz[c] += v[c];
      squares[c] += rgb[c] * rgb[c];
    }
    ++record.samples;
  }
  for (std::size_t c = 0; c < 3; ++c) {
    record.xyz[c] = static_cast<float>(xyz[c]);
    record.xyz_low[c] = static_cast<float>(record.xyz[c] - xyz[c]);  // what the float sum has too much
    record.rgb_squared[c] = static_cast<float>(squares[c]);
    record.rgb_squared_low[c] = static_cast<float>(record.rgb_squared[c] - squares[c]);
  }
  return record;
}

float value(const LayeredImage& image, const char* channel, std::size_t pixel = 0) {
  return image.find(channel)->floats.at(pixel);
}

// The result is rounded to float (6e-8) once, from sums kept to about 2^-48; values are up to 16.
constexpr double rounding = 1e-6;

TEST(Develop, MeansOfTheSamples) {
  const auto image = develop({with_samples({{1, 0.5, 0.25}, {3, 0.5, 0.75}})}, window(1, 1), Scene{}, true);
  EXPECT_NEAR(value(image, "R"), 2, rounding);
  EXPECT_NEAR(value(image, "G"), 0.5, rounding);
  EXPECT_NEAR(value(image, "B"), 0.5, rounding);
}

TEST(Develop, VarianceOfTheMean) {
  // Red 1 and 3: variance of the samples (divisor n) 1, of the mean 1 / (n - 1) = 1. Blue 0.25, 0.75: 0.0625. Green: none.
  const auto image = develop({with_samples({{1, 0.5, 0.25}, {3, 0.5, 0.75}})}, window(1, 1), Scene{}, true);
  EXPECT_NEAR(value(image, "variance.R"), 1, rounding);
  EXPECT_NEAR(value(image, "variance.G"), 0, rounding);
  EXPECT_NEAR(value(image, "variance.B"), 0.0625, rounding);
  EXPECT_GE(value(image, "variance.G"), 0);
  // 1, 3 and 5: 35 / 3 - 9 = 8 / 3, over n - 1 = 2.
  const auto three = develop({with_samples({{1, 0, 0}, {3, 0, 0}, {5, 0, 0}})}, window(1, 1), Scene{}, true);
  EXPECT_NEAR(value(three, "variance.R"), 4.0 / 3, 2 * rounding);
}

TEST(Develop, VarianceOfOneSampleIsZeroAndOnRequest) {
  EXPECT_EQ(value(develop({with_samples({{1, 2, 3}})}, window(1, 1), Scene{}, true), "variance.R"), 0);
  EXPECT_EQ(develop({with_samples({{1, 2, 3}})}, window(1, 1), Scene{}, false).find("variance.R"), nullptr);
}

TEST(Develop, CompensationIsSubtracted) {
  // A sum of 2^24 + 1 does not fit a float: 2^24 + 2 with 1 too much does. Grey, so that the matrix only maps white to white.
  FilmRecord record = nothing();
  record.samples = 1 << 24;
  const auto white = xyz_of_srgb(1, 1, 1);
  for (std::size_t c = 0; c < 3; ++c) {
    record.xyz[c] = 16777218.0f;
    record.xyz_low[c] = static_cast<float>(16777218.0 - 16777216.0 * white[c] * 3);
  }
  const auto image = develop({record}, window(1, 1), Scene{}, false);
  EXPECT_NEAR(value(image, "G"), 3, rounding);
}

TEST(Develop, ExposureScalesColorAndVariance) {
  Scene scene;
  scene.film.exposure_time = 0.5;
  scene.film.iso = 400;
  const auto image = develop({with_samples({{1, 0, 0}, {3, 0, 0}})}, window(1, 1), scene, true);
  EXPECT_NEAR(value(image, "R"), 4, rounding);
  EXPECT_NEAR(value(image, "variance.R"), 4, rounding);
}

TEST(Develop, MaxComponentValueKeepsTheHue) {
  Scene scene;
  scene.film.max_component_value = 1;
  const auto image = develop({with_samples({{4, 2, 1}})}, window(1, 1), scene, false);
  EXPECT_NEAR(value(image, "R"), 1, rounding);
  EXPECT_NEAR(value(image, "G"), 0.5, rounding);
  EXPECT_NEAR(value(image, "B"), 0.25, rounding);
}

TEST(Develop, FirstHitLayersAreMeansOverHits) {
  FilmRecord record = nothing();
  record.samples = 4;
  record.hits = 2;
  record.object = 7;
  record.primitive = 3000000000u;
  for (std::size_t c = 0; c < 3; ++c) {
    record.albedo[c] = 1.0f;
    record.normal[c] = c == 2 ? 2.0f : 0.0f;
    record.position[c] = 6.0f + static_cast<float>(c);
  }
  record.depth = 5;
  const auto image = develop({record}, window(1, 1), Scene{}, false);
  EXPECT_EQ(value(image, "A"), 0.5f);
  EXPECT_EQ(value(image, "albedo.R"), 0.25f);
  EXPECT_EQ(value(image, "N.Z"), 1.0f);
  EXPECT_EQ(value(image, "P.X"), 3.0f);
  EXPECT_EQ(value(image, "P.Z"), 4.0f);
  EXPECT_EQ(value(image, "Z"), 2.5f);
  EXPECT_EQ(image.find("object.id")->uints.at(0), 7u);
  EXPECT_EQ(image.find("primitive.id")->uints.at(0), 3000000000u);
}

TEST(Develop, EmptyPixelsAreFinite) {
  FilmRecord missed = nothing();
  missed.samples = 16;
  const auto image = develop({missed, nothing()}, window(2, 1), Scene{}, true);
  for (const Channel& channel : image.channels)
    for (const float v : channel.floats) EXPECT_EQ(v, channel.name == "Z" ? 1e10f : 0.0f) << channel.name;
  EXPECT_EQ(image.find("object.id")->uints.at(1), 0xffffffffu);
}

TEST(Develop, WindowsAndOrder) {
  const auto image =
      develop({with_samples({{1, 1, 1}}), with_samples({{2, 2, 2}}), with_samples({{3, 3, 3}})}, window(1, 3), Scene{}, false);
  EXPECT_EQ(image.width, 10);
  EXPECT_EQ(image.height, 6);
  EXPECT_EQ(image.x, 3);
  EXPECT_EQ(image.y, 2);
  EXPECT_EQ(image.data_width, 1);
  EXPECT_EQ(image.data_height, 3);
  EXPECT_NEAR(value(image, "R", 2), 3, rounding);
  EXPECT_THROW(develop({nothing()}, window(2, 1), Scene{}, false), std::logic_error);
}

TEST(Chromaticities, AgreeWithTheSpectralSide) {
  for (const ColorSpace space : {ColorSpace::srgb, ColorSpace::dci_p3, ColorSpace::rec2020, ColorSpace::aces2065_1}) {
    const auto round_trip = product(rgb_from_xyz(space), xyz_from_rgb(chromaticities_of(space)));
    // Whites taken from a spectrum or as xy differ by up to 2e-4 in XYZ.
    for (std::size_t i = 0; i < 9; ++i)
      EXPECT_NEAR(round_trip[i], i % 4 == 0 ? 1 : 0, 2e-3) << static_cast<int>(space) << " " << i;
  }
}

TEST(Chromaticities, SrgbMatrixIsTheStandards) {
  const auto m = xyz_from_rgb(chromaticities_of(ColorSpace::srgb));
  const std::array<double, 9> expected{0.4123908, 0.3575843, 0.1804808, 0.2126390, 0.7151687,
                                       0.0721923, 0.0193308, 0.1191948, 0.9505322};
  for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(m[i], expected[i], 1e-7) << i;
  const auto identity = product(m, inverse(m));
  for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(identity[i], i % 4 == 0 ? 1 : 0, 1e-14);
}

}  // namespace
}  // namespace caplet
