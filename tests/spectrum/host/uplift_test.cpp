// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// RGB -> spectrum -> RGB. The colours of spectra are summed here by another rule (quarter
// nanometres) and with the published sRGB matrix, so that they do not share the solver's response
// tables.
#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <glm/common.hpp>
#include <random>

#include "lower/detail/spectrum_color.h"
#include "lower/detail/spectrum_observer.h"
#include "lower/detail/spectrum_uplift.h"
#include "lower/spectrum.h"

namespace caplet {
namespace {

double joined(const double* table, int stride, double place) {
  const int cell = std::min(static_cast<int>(place), CAPLET_LAMBDA_COUNT - 2);
  return table[stride * cell] +
         (place - cell) * (table[stride * (cell + 1)] - table[stride * cell]);
}

/// Linear sRGB of a reflectance under D65, white being (1, 1, 1).
template <class Reflectance>
glm::dvec3 srgb_under_d65(Reflectance reflectance) {
  static const SpectrumSamples light = sample(*named_spectrum("stdillum-D65"));
  // IEC 61966-2-1 with the white of CIE 15; the rows are divided by their value for our white
  // below.
  constexpr double m[3][3] = {{3.2404542, -1.5371385, -0.4985314},
                              {-0.9692660, 1.8760108, 0.0415560},
                              {0.0556434, -0.2040259, 1.0572252}};
  glm::dvec3 color(0), white(0);
  for (int i = 0; i < 4 * (CAPLET_LAMBDA_COUNT - 1); ++i) {
    const double place = (i + 0.5) / 4;
    const double power = joined(light.data(), 1, place), value = reflectance(360 + place);
    for (int row = 0; row < 3; ++row) {
      double response = 0;
      for (int c = 0; c < 3; ++c) response += m[row][c] * joined(cie_1931_observer + c, 3, place);
      white[row] += response * power;
      color[row] += response * power * value;
    }
  }
  return color / white;
}

double largest_difference(const glm::dvec3& a, const glm::dvec3& b) {
  const glm::dvec3 d = glm::abs(a - b);
  return std::max({d.x, d.y, d.z});
}

TEST(Uplift, EveryColorOfSrgbComesBack) {
  constexpr int steps = 8;
  double worst = 0;
  for (int r = 0; r <= steps; ++r)
    for (int g = 0; g <= steps; ++g)
      for (int b = 0; b <= steps; ++b) {
        const glm::dvec3 rgb = glm::dvec3(r, g, b) / double{steps};
        const SigmoidFit fit = fit_sigmoid(rgb, ColorSpace::srgb);
        const glm::dvec3 back =
            srgb_under_d65([&](double nm) { return sigmoid_value(fit.coefficients, nm); });
        const double difference = largest_difference(back, rgb);
        worst = std::max(worst, difference);
        EXPECT_LT(difference, 1e-4) << r << ' ' << g << ' ' << b << " residual " << fit.residual;
      }
  RecordProperty("worst", std::to_string(worst));
}

TEST(Uplift, NearlyGreyNearlyBlackNearlyWhite) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int i = 0; i < 300; ++i) {
    const double base = i % 3 == 0 ? 1e-4 : i % 3 == 1 ? 0.5 : 0.9995, spread = 1e-4;
    const glm::dvec3 rgb =
        glm::dvec3(base) + spread * glm::dvec3(uniform(random), uniform(random), uniform(random));
    const SigmoidFit fit = fit_sigmoid(rgb, ColorSpace::srgb);
    const glm::dvec3 back =
        srgb_under_d65([&](double nm) { return sigmoid_value(fit.coefficients, nm); });
    // A hundredth of the spread where a sigmoid can follow it; near white and black the spectra are
    // already boxes of full contrast.
    EXPECT_LT(largest_difference(back, rgb), i % 3 == 1 ? 1e-6 : 1e-4)
        << rgb.x << ' ' << rgb.y << ' ' << rgb.z;
  }
}

TEST(Uplift, GreyIsConstant) {
  for (const double grey : {0.001, 0.18, 0.5, 0.9}) {
    const SigmoidFit fit = fit_sigmoid(glm::dvec3(grey), ColorSpace::srgb);
    EXPECT_EQ(fit.coefficients[0], 0);
    EXPECT_EQ(fit.coefficients[1], 0);
    EXPECT_NEAR(sigmoid_value(fit.coefficients, 500), grey, 1e-12);
  }
}

TEST(Uplift, ColorsBeyondAnySpectrumStayFinite) {
  for (const ColorSpace space : {ColorSpace::dci_p3, ColorSpace::rec2020, ColorSpace::aces2065_1})
    for (const glm::dvec3 rgb : {glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(0, 0, 1),
                                 glm::dvec3(0, 1, 1), glm::dvec3(1, 0, 1)}) {
      const SigmoidFit fit = fit_sigmoid(rgb, space);
      for (const double nm : {360.0, 450.0, 550.0, 650.0, 830.0}) {
        EXPECT_GE(sigmoid_value(fit.coefficients, nm), 0);
        EXPECT_LE(sigmoid_value(fit.coefficients, nm), 1);
      }
    }
  // Half as bright and half as saturated they are ordinary colours again.
  for (const ColorSpace space : {ColorSpace::dci_p3, ColorSpace::rec2020, ColorSpace::aces2065_1})
    EXPECT_LT(fit_sigmoid({0.5, 0.25, 0.25}, space).residual, 1e-6);
}

// The interpolated table against the colour asked for, relative to its largest channel.
// docs/numerics.md states the figures.
TEST(Uplift, EnvironmentTexels) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform(0, 1);
  double worst = 0, sum = 0;
  constexpr int colors = 2000;
  for (int i = 0; i < colors; ++i) {
    glm::dvec3 rgb(uniform(random), uniform(random), uniform(random));
    if (i % 4 == 0) rgb[i / 4 % 3] *= 1e-2 * uniform(random);  // saturated ones too
    if (i % 16 == 0) rgb[(i / 16 + 1) % 3] = 0;
    rgb *= std::exp(20 * uniform(random) - 10);
    const std::array<float, 4> texel = environment_texel(rgb, ColorSpace::srgb);
    const glm::dvec3 back = srgb_under_d65([&](double nm) {
      return double{texel[3]} *
             sigmoid_value({double{texel[0]}, double{texel[1]}, double{texel[2]}}, nm);
    });
    const double difference = largest_difference(back, rgb) / std::max({rgb.x, rgb.y, rgb.z});
    worst = std::max(worst, difference);
    sum += difference * difference;
  }
  EXPECT_LT(worst, 3e-4);
  EXPECT_LT(std::sqrt(sum / colors), 1e-4);
  RecordProperty("worst", std::to_string(worst));
  RecordProperty("rms", std::to_string(std::sqrt(sum / colors)));
}

// The first texel of a space makes its table, in parallel, inside whatever loop asked: a thread
// that waits for parts of the table must not take another texel meanwhile, for that one waits for
// the table. Four texels and six threads make that likely (about one process in two hung when
// nothing prevented it); each process begins without tables, and one that hangs is ended.
TEST(UpliftDeathTest, FirstTexelsMayBeAskedForInParallel) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const auto first_texels = [] {
    alarm(60);
    const tbb::global_control threads(tbb::global_control::max_allowed_parallelism, 6);
    for (const ColorSpace space :
         {ColorSpace::srgb, ColorSpace::dci_p3, ColorSpace::rec2020, ColorSpace::aces2065_1}) {
      std::array<std::array<float, 4>, 4> texels;
      tbb::parallel_for(
          std::size_t{0}, texels.size(),
          [&](std::size_t i) {
            texels[i] = environment_texel(glm::dvec3(0.5, 0.25, 0.125), space);
          },
          tbb::simple_partitioner());
      for (const std::array<float, 4>& texel : texels)
        if (texel != texels[0] || texel[3] != 1) std::_Exit(1);
    }
    std::_Exit(0);
  };
  for (int process = 0; process < 4; ++process)
    ASSERT_EXIT(first_texels(), testing::ExitedWithCode(0), "");
}

TEST(Uplift, GreyTexelsAreExactAndBlackOnesDark) {
  const std::array<float, 4> grey = environment_texel(glm::dvec3(3), ColorSpace::srgb);
  EXPECT_EQ(grey, (std::array<float, 4>{0, 0, 0, 6}));
  EXPECT_EQ(environment_texel(glm::dvec3(0), ColorSpace::srgb)[3], 0);
  EXPECT_EQ(environment_texel(glm::dvec3(-1, -2, -3), ColorSpace::srgb)[3], 0);
}

}  // namespace
}  // namespace caplet
