// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// What spectra become on the device: kinds, normalisation, sharing, wavelength sampling.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <glm/mat3x3.hpp>

#include "lower/detail/spectrum_color.h"
#include "lower/spectrum.h"

namespace caplet {
namespace {

/// Value of a record at a sample of the 1 nm tables.
double value_of(const FlatScene& scene, std::uint32_t index, std::size_t sample) {
  const SpectrumRecord& record = scene.spectra.at(index);
  const double nm = 360 + static_cast<double>(sample);
  const std::array<double, 3> c = {record.c0, record.c1, record.c2};
  switch (record.kind) {
    case spectrum_constant:
      return record.scale;
    case spectrum_table:
      return double{record.scale} * double{scene.spectrum_tables.at(record.table + sample)};
    case spectrum_sigmoid:
      return record.scale * sigmoid_value(c, nm);
    default:
      return record.scale * sigmoid_value(c, nm) *
             double{scene.spectrum_tables.at(record.table + sample)};
  }
}

/// Linear sRGB of a record seen as light, summed at 1 nm from the scene's own observer table.
glm::dvec3 rgb_of(const FlatScene& scene, std::uint32_t index,
                  ColorSpace space = ColorSpace::srgb) {
  glm::dvec3 xyz(0);
  for (std::size_t i = 0; i < CAPLET_LAMBDA_COUNT; ++i)
    for (int c = 0; c < 3; ++c)
      xyz[c] += value_of(scene, index, i) *
                double{scene.observer.at(4 * i + static_cast<std::size_t>(c))};
  const std::array<double, 9> m = rgb_from_xyz(space);
  return {m[0] * xyz.x + m[1] * xyz.y + m[2] * xyz.z, m[3] * xyz.x + m[4] * xyz.y + m[5] * xyz.z,
          m[6] * xyz.x + m[7] * xyz.y + m[8] * xyz.z};
}

Spectrum rgb(double r, double g, double b, ColorSpace space = ColorSpace::srgb) {
  return RgbSpectrum{{r, g, b}, space};
}

void expect_color(const glm::dvec3& color, const glm::dvec3& expected, double tolerance) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(color[c], expected[c], tolerance) << "channel " << c;
}

TEST(SpectrumTable, EmittersShowTheirRgb) {
  for (const ColorSpace space :
       {ColorSpace::srgb, ColorSpace::dci_p3, ColorSpace::rec2020, ColorSpace::aces2065_1}) {
    FlatScene scene;
    SpectrumTable table(scene, space);
    // Tables and coefficients are floats: 1e-5 of the largest channel.
    expect_color(rgb_of(scene, table.add_illuminant(rgb(1, 1, 1, space)), space), {1, 1, 1}, 2e-5);
    expect_color(rgb_of(scene, table.add_illuminant(rgb(17, 12, 4, space)), space), {17, 12, 4},
                 17e-5);
    expect_color(rgb_of(scene, table.add_illuminant(rgb(0, 0, 0, space)), space), {0, 0, 0}, 0);
  }
}

TEST(SpectrumTable, OtherEmittersHaveLuminanceOne) {
  FlatScene scene;
  SpectrumTable table(scene, ColorSpace::srgb);
  for (const Spectrum& spectrum :
       {Spectrum(ConstantSpectrum{7}), Spectrum(BlackbodySpectrum{3000}),
        *named_spectrum("stdillum-F4"), Spectrum(SampledSpectrum{{400, 500, 700}, {3, 4, 5}})}) {
    const std::uint32_t index = table.add_illuminant(spectrum);
    double y = 0;
    for (std::size_t i = 0; i < CAPLET_LAMBDA_COUNT; ++i)
      y += value_of(scene, index, i) * double{scene.observer[4 * i + 1]};
    EXPECT_NEAR(
        y, 1,
        5e-5);  // 1 nm sum against the exact integral of the products: 3e-5 for the lines of F4
    EXPECT_NEAR(table.illuminant_luminance(spectrum), 1, 1e-12);
  }
  EXPECT_NEAR(table.illuminant_luminance(rgb(1, 1, 1)), 1, 1e-12);
  EXPECT_NEAR(table.illuminant_luminance(rgb(0, 4, 0)), 4 * 0.7152,
              4e-4);  // Rec. 709: Y of green, printed to 4 digits
  EXPECT_EQ(table.illuminant_luminance(ConstantSpectrum{0}), 0);
  EXPECT_EQ(value_of(scene, table.add_illuminant(ConstantSpectrum{0}), 100), 0);
}

TEST(SpectrumTable, ReflectancesStayWithinZeroAndOne) {
  FlatScene scene;
  SpectrumTable table(scene, ColorSpace::srgb);
  EXPECT_EQ(value_of(scene, table.add_reflectance(ConstantSpectrum{1.5}), 0), 1);
  EXPECT_EQ(value_of(scene, table.add_reflectance(rgb(2, 2, 2)), 0), 1);
  EXPECT_EQ(value_of(scene, table.add_reflectance(rgb(-1, -2, 0)), 0), 0);
  const std::uint32_t wide = table.add_reflectance(SampledSpectrum{{400, 500, 600}, {-1, 3, 0.25}});
  EXPECT_EQ(value_of(scene, wide, 0), 0);
  EXPECT_EQ(value_of(scene, wide, 140), 1);
  EXPECT_EQ(value_of(scene, wide, 470), 0.25);
  const std::uint32_t grey = table.add_reflectance(rgb(0.5, 0.5, 0.5));
  EXPECT_EQ(scene.spectra[grey].kind, static_cast<uint>(spectrum_constant));
  EXPECT_EQ(scene.spectra[grey].scale, 0.5f);
}

TEST(SpectrumTable, UnboundedKeepsMagnitude) {
  FlatScene scene;
  SpectrumTable table(scene, ColorSpace::srgb);
  EXPECT_EQ(value_of(scene, table.add_unbounded(ConstantSpectrum{3.9}), 5), double{3.9f});
  EXPECT_EQ(value_of(scene, table.add_unbounded(rgb(3, 3, 3)), 5), 3);
  const std::uint32_t gold = table.add_unbounded(*named_spectrum("metal-Au-Johnson-k"));
  EXPECT_NEAR(value_of(scene, gold, 290), 3.60244,
              1e-5);  // reference/tables/metal_nk_samples.csv: 0.65 um
  const std::uint32_t colored = table.add_unbounded(rgb(0.2, 3, 1));
  EXPECT_LE(value_of(scene, colored, 100), 6);
}

TEST(SpectrumTable, EqualSpectraAreShared) {
  FlatScene scene;
  SpectrumTable table(scene, ColorSpace::srgb);
  const std::size_t tables = scene.spectrum_tables.size();
  EXPECT_EQ(tables, std::size_t{CAPLET_LAMBDA_COUNT});
  EXPECT_EQ(table.add_reflectance(rgb(0.1, 0.2, 0.3)), table.add_reflectance(rgb(0.1, 0.2, 0.3)));
  EXPECT_NE(table.add_reflectance(rgb(0.1, 0.2, 0.3)), table.add_reflectance(rgb(0.1, 0.2, 0.31)));
  EXPECT_EQ(table.add_unbounded(*named_spectrum("metal-Cu-k")),
            table.add_unbounded(*named_spectrum("metal-Cu-k")));
  EXPECT_EQ(scene.spectrum_tables.size(), tables + CAPLET_LAMBDA_COUNT);
  EXPECT_EQ(table.illuminant_table(ColorSpace::rec2020), scene.world.illuminant_table);  // D65 both
  EXPECT_NE(table.illuminant_table(ColorSpace::aces2065_1), scene.world.illuminant_table);
}

TEST(SpectrumTable, ConstantSpectraAreRecognised) {
  EXPECT_TRUE(is_constant(ConstantSpectrum{2}));
  EXPECT_TRUE(is_constant(rgb(2, 2, 2)));
  EXPECT_TRUE(is_constant(SampledSpectrum{{300, 900}, {0.2, 0.2}}));
  EXPECT_FALSE(is_constant(rgb(2, 2, 2.1)));
  EXPECT_FALSE(is_constant(*named_spectrum("glass-BK7")));
  EXPECT_FALSE(is_constant(BlackbodySpectrum{5000}));
}

TEST(Evaluate, SampledAndBlackbody) {
  const SampledSpectrum ramp{{400, 500, 700}, {1, 2, 6}};
  EXPECT_EQ(evaluate(ramp, 300), 1);
  EXPECT_EQ(evaluate(ramp, 450), 1.5);
  EXPECT_EQ(evaluate(ramp, 500), 2);
  EXPECT_EQ(evaluate(ramp, 600), 4);
  EXPECT_EQ(evaluate(ramp, 900), 6);
  EXPECT_NEAR(evaluate(BlackbodySpectrum{5000}, 2.897771955e6 / 5000), 1, 1e-12);
  // Rayleigh-Jeans and Wien's limits, as ratios of Planck's law between two wavelengths.
  EXPECT_NEAR(evaluate(BlackbodySpectrum{1e9}, 400) / evaluate(BlackbodySpectrum{1e9}, 800), 16,
              1e-3);
  const double wien =
      std::pow(800.0 / 400, 5) * std::exp(-1.438776877e7 / 1500 * (1 / 400.0 - 1 / 800.0));
  EXPECT_NEAR(evaluate(BlackbodySpectrum{1500}, 400) / evaluate(BlackbodySpectrum{1500}, 800), wien,
              1e-5 * wien);
}

TEST(ColorMatrices, SrgbAsPublished) {
  // IEC 61966-2-1, whose white is D65 to four digits; ours is the tabulated D65's: they differ
  // by 3.1e-5 at most.
  const double published[9] = {3.2404542, -1.5371385, -0.4985314, -0.9692660, 1.8760108,
                               0.0415560, 0.0556434,  -0.2040259, 1.0572252};
  const std::array<double, 9> m = rgb_from_xyz(ColorSpace::srgb),
                              inverse = xyz_from_rgb(ColorSpace::srgb);
  for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(m[i], published[i], 4e-5);
  for (std::size_t row = 0; row < 3; ++row)
    for (std::size_t column = 0; column < 3; ++column) {
      double product = 0;
      for (std::size_t k = 0; k < 3; ++k) product += m[3 * row + k] * inverse[3 * k + column];
      EXPECT_NEAR(product, row == column ? 1 : 0, 1e-13);
    }
}

TEST(Wavelengths, TableCoversTheRange) {
  FlatScene scene;
  const SpectrumTable table(scene, ColorSpace::srgb);
  ASSERT_EQ(scene.wavelength_table.size(), 1025u);
  EXPECT_EQ(scene.wavelength_table.front(), CAPLET_LAMBDA_MIN);
  EXPECT_EQ(scene.wavelength_table.back(), CAPLET_LAMBDA_MAX);
  for (std::size_t i = 0; i < 1024; ++i)
    EXPECT_LT(scene.wavelength_table[i], scene.wavelength_table[i + 1]);
}

}  // namespace
}  // namespace caplet
