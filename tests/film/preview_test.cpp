// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Tone mapping and preview files.
#include "film/preview.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "film/transfer.h"
#include "images.h"
#include "support/data.h"

namespace caplet {
namespace {

using testing::HasSubstr;

LayeredImage picture(const std::vector<std::array<float, 3>>& pixels) {
  LayeredImage image;
  image.width = image.data_width = static_cast<int>(pixels.size());
  image.height = image.data_height = 1;
  const char* names[3] = {"R", "G", "B"};
  for (std::size_t c = 0; c < 3; ++c) {
    image.channels.push_back({names[c], {}, {}});
    for (const auto& pixel : pixels) image.channels.back().floats.push_back(pixel[c]);
  }
  return image;
}

TEST(Transfer, IsTheStandardsCurve) {
  // IEC 61966-2-1: both pieces meet at 0.0031308; middle values from the formula worked out
  // separately.
  EXPECT_FLOAT_EQ(srgb_from_linear(0), 0);
  EXPECT_NEAR(srgb_from_linear(1), 1, 1e-6);
  EXPECT_NEAR(srgb_from_linear(0.18f), 0.4613561, 1e-6);
  EXPECT_NEAR(srgb_from_linear(0.0031308f), 0.0031308 * 12.92, 1e-6);
  EXPECT_NEAR(linear_from_srgb(0.5f), 0.2140411, 1e-6);
  for (int i = 0; i <= 255; ++i) {
    const float v = static_cast<float>(i) / 255;
    // The standard's constants close the circle to 1e-6 only at the joint.
    EXPECT_NEAR(srgb_from_linear(linear_from_srgb(v)), v, 2e-6) << i;
  }
}

TEST(ToneMap, LeavesTheLowerHalfAlone) {
  const auto out = tone_map({0.5f, 0.18f, 0});
  EXPECT_EQ(out, (std::array<float, 3>{0.5f, 0.18f, 0}));
}

TEST(ToneMap, IsMonotoneSmoothAndBelowOne) {
  float last = 0, slope = 1;
  for (int i = 1; i <= 4000; ++i) {
    const float v = 0.005f * static_cast<float>(i);
    const float out = tone_map({v, v, v})[0];
    ASSERT_GE(out, last - 1.2e-7f) << v;  // two roundings near 1
    ASSERT_LE(out, 1.0f);
    const float next_slope = (out - last) / 0.005f;
    // exp's slope falls by 2 a unit at most: 0.01 a step, and rounding of out (6e-8) over the step
    // is 2.4e-5.
    ASSERT_NEAR(next_slope, slope, 0.0101f) << v;
    slope = next_slope;
    last = out;
  }
  EXPECT_GT(last, 0.999f);
  EXPECT_NEAR(tone_map({1, 1, 1})[0], 1 - 0.5 * std::exp(-1.0), 1e-6);
}

TEST(ToneMap, KeepsTheOrderAndHueOfComponents) {
  for (const float scale : {0.1f, 1.0f, 3.0f, 30.0f}) {
    const auto out = tone_map({0.9f * scale, 0.5f * scale, 0.1f * scale});
    EXPECT_GT(out[0], out[1]);
    EXPECT_GT(out[1], out[2]);
    // Mixing with white and scaling keep the hue: (G - B) / (R - B) stays.
    EXPECT_NEAR((out[1] - out[2]) / (out[0] - out[2]), 0.5, 1e-4) << scale;
  }
}

TEST(ToneMap, SurvivesWhateverComes) {
  const float infinity = std::numeric_limits<float>::infinity(),
              nan = std::numeric_limits<float>::quiet_NaN();
  for (const auto& odd :
       {std::array<float, 3>{nan, 0.25f, -1}, {infinity, 0, 0}, {-infinity, 0, nan}, {3e38f, 1, 0}})
    for (const float v : tone_map(odd)) {
      EXPECT_GE(v, 0);
      EXPECT_LE(v, 1);
    }
  EXPECT_EQ(tone_map({nan, 0.25f, -1}), (std::array<float, 3>{0, 0.25f, 0}));
}

TEST(Preview, BytesAreSrgb) {
  const auto bytes = preview_rgb8(picture({{0, 0.18f, 0.5f}, {1e6f, 1e6f, 1e6f}}));
  // 0.18 -> 0.4613561 * 255 = 117.6; 0.5 -> 0.7353570 * 255 = 187.5.
  EXPECT_EQ(bytes[0], 0);
  EXPECT_EQ(bytes[1], 118);
  EXPECT_NEAR(bytes[2], 187.5, 0.51);
  EXPECT_EQ(bytes[3], 255);
}

LayeredImage over(LayeredImage image, std::vector<float> coverage,
                  const std::optional<Backdrop>& backdrop) {
  image.channels.push_back({"A", std::move(coverage), {}});
  image.backdrop = backdrop;
  return image;
}

TEST(Exposure, ChangesTheLightOfShapesBeforeTheCurve) {
  LayeredImage image = picture({{0.1f, 0.05f, 0}, {0.3f, 0.3f, 0.3f}});
  image.exposure.stops = 2;
  const Shown out = shown(image);
  EXPECT_EQ(out.rgb[0], (std::array<float, 3>{0.4f, 0.2f, 0}));
  EXPECT_EQ(out.rgb[1], tone_map({1.2f, 1.2f, 1.2f}));
  image.exposure.stops = -1;
  EXPECT_EQ(shown(image).rgb[0], (std::array<float, 3>{0.05f, 0.025f, 0}));
  // Half a pixel of grey 0.2 over a backdrop of 0.6 is 0.4, and 0.5 when the grey is 0.4.
  const Backdrop grey{Backdrop::Kind::color, glm::dvec3(0.6), nullptr};
  image = over(picture({{0.4f, 0.4f, 0.4f}, {0.6f, 0.6f, 0.6f}}), {0.5f, 0}, grey);
  EXPECT_NEAR(shown(image).rgb[0][1], 0.4, 1e-6);
  image.exposure.stops = 1;
  EXPECT_NEAR(shown(image).rgb[0][1], 0.5, 1e-6);
  EXPECT_NEAR(shown(image).rgb[1][1], 0.6, 1e-6);
  image = over(picture({{0.1f, 0.1f, 0.1f}}), {0.5f}, Backdrop{});
  image.exposure.stops = 1;
  EXPECT_NEAR(shown(image).rgb[0][1], 0.4, 1e-6);
  EXPECT_EQ(shown(image).alpha[0], 0.5f);
}

/// `dark` pixels of 0.002, then `bright` ones whose green is `light`.
LayeredImage two_lights(int dark, int bright, float light) {
  std::vector<std::array<float, 3>> pixels(static_cast<std::size_t>(dark),
                                           {0.002f, 0.002f, 0.002f});
  pixels.insert(pixels.end(), static_cast<std::size_t>(bright), {0.1f * light, light, 0});
  return picture(pixels);
}

double metered(const LayeredImage& image) {
  ExposureMeter meter;
  meter.add(image);
  return meter.stops();
}

TEST(Exposure, IsMeteredByTheLightThatFewPixelsExceed) {
  constexpr double step = 1.0 / 32;
  for (const float light : {0.01f, 0.1f, 0.8f, 7.0f, 1e4f}) {
    // More than a twentieth are bright; then fewer are.
    EXPECT_NEAR(metered(two_lights(94, 6, light)), std::log2(0.8 / double{light}), step + 1e-5);
    EXPECT_NEAR(metered(two_lights(96, 4, light)), std::log2(0.8 / 0.002), step + 1e-5);
  }
  EXPECT_EQ(metered(two_lights(100, 0, 1)), metered(two_lights(7, 0, 1)));
  EXPECT_EQ(metered(picture({{0, 0, 0}, {-1, 0, 0}})), 0);
  EXPECT_EQ(metered(picture({{1e-14f, 0, 0}})), 0);  // below 2^-40
  constexpr float nan = std::numeric_limits<float>::quiet_NaN(),
                  infinite = std::numeric_limits<float>::infinity();
  EXPECT_NEAR(metered(picture({{infinite, 0, 0}, {nan, nan, nan}, {0.2f, 0, 0}})), 2, step);
  EXPECT_EQ(metered(picture({{1e30f, 0, 0}})), -32);
}

TEST(Exposure, IsMeteredByCoverage) {
  // What no shape covers does not count, with a backdrop or without one.
  LayeredImage sky = over(picture({{9, 9, 9}, {9, 9, 9}, {0.2f, 0.2f, 0.2f}}), {0, 0, 1}, {});
  EXPECT_NEAR(metered(sky), 2, 1.0 / 32);
  sky.backdrop = Backdrop{Backdrop::Kind::color, glm::dvec3(9), nullptr};
  EXPECT_NEAR(metered(sky), 2, 1.0 / 32);
  // Half a pixel of 0.4.
  const LayeredImage half = over(picture({{0.2f, 0.2f, 0.2f}}), {0.5f}, Backdrop{});
  EXPECT_NEAR(metered(half), 1, 1.0 / 32);
  // A thin share of the picture is bright, whether it is in one band or in several.
  ExposureMeter meter;
  meter.add(two_lights(90, 0, 1));
  meter.add(two_lights(4, 6, 1));
  EXPECT_EQ(meter.stops(), metered(two_lights(94, 6, 1)));
}

TEST(Exposure, OfThePicture) {
  LayeredImage image = two_lights(90, 10, 0.05f);
  image.exposure.is_automatic = true;
  const float green = shown(image).rgb.back()[1];
  EXPECT_LT(tone_map({0, 0.8f * std::exp2(-1.0f / 31), 0})[1], green);
  EXPECT_GT(tone_map({0, 0.8f * std::exp2(1.0f / 31), 0})[1], green);
  image.exposure = {metered(image), false};
  EXPECT_EQ(shown(image).rgb.back()[1], green);
}

TEST(Preview, ConvertsToSrgbPrimaries) {
  // (0.18, 0.18, 0.18) is grey in every D65 space; saturated Rec. 2020 green lies outside sRGB and
  // clips its red to 0.
  LayeredImage image = picture({{0.18f, 0.18f, 0.18f}, {0, 0.3f, 0}, {0.2f, 0.3f, 0.1f}});
  image.space = ColorSpace::rec2020;
  const auto bytes = preview_rgb8(image);
  EXPECT_EQ(bytes[0], 118);
  EXPECT_EQ(bytes[1], 118);
  EXPECT_EQ(bytes[2], 118);
  EXPECT_EQ(bytes[3], 0);
  EXPECT_GT(bytes[4], 118);
  // By the matrix of ITU-R BT.2087 (0.148521, 0.314125, 0.078069), and sRGB's curve: 107.5, 152.0
  // and 78.9.
  EXPECT_EQ(bytes[6], 108);
  EXPECT_EQ(bytes[7], 152);
  EXPECT_EQ(bytes[8], 79);
}

#ifdef CAPLET_WITH_OIIO

TEST(Preview, FilesComeBack) {
  const auto folder = test::temporary_folder();
  const LayeredImage image = picture({{0, 0.18f, 0.5f}, {0.2f, 0.1f, 0.05f}});
  const auto bytes = preview_rgb8(image);
  for (const char* name : {"a.png", "a.tif", "a.bmp", "a.ppm"}) {
    EXPECT_NO_THROW(check_preview_format(folder / name, "--preview"));
    write_preview(folder / name, image);
    const EnvironmentImage back = FileImageReader().read_rgb(folder / name);
    ASSERT_EQ(back.width, 2) << name;
    ASSERT_EQ(back.height, 1) << name;
    for (std::size_t i = 0; i < bytes.size(); ++i)
      EXPECT_NEAR(back.rgb[i], linear_from_srgb(static_cast<float>(bytes[i]) / 255), 1e-6)
          << name << " " << i;
  }
  write_preview(folder / "a.jpg", image);
  EXPECT_EQ(FileImageReader().read_rgb(folder / "a.jpg").width, 2);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder), {}), 5);
}

TEST(Preview, FormatsAreKnownBeforehand) {
  for (const char* name : {"a.exr", "a.xyz", "a", ".png"}) {
    try {
      check_preview_format(name, "--preview");
      ADD_FAILURE() << name;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr("--preview: ")) << name;
    }
  }
}

#else

TEST(Preview, NamesTheBuildOption) {
  EXPECT_NO_THROW(check_preview_format("a.png", "--preview"));
  EXPECT_THROW(check_preview_format("a.jpg", "--preview"), InputError);
  EXPECT_THROW(write_preview(test::temporary_folder() / "a.jpg", picture({{1, 1, 1}})), InputError);
}

#endif

}  // namespace
}  // namespace caplet
