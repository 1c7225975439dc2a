// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Lights without a shape against closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <random>

#include "light_bench.h"
#include "light_scenes.h"

namespace caplet::test::lights_test {

namespace {

using std::numbers::pi;

std::vector<float> uneven_image(int texels) {
  std::mt19937 engine(5);
  std::vector<float> rgb;
  for (int i = 0; i < texels; ++i) {
    const float grey = std::exp(-static_cast<float>(engine() >> 8) * 0x1p-24f * 6);
    rgb.insert(rgb.end(), {grey, grey, grey});
  }
  return rgb;
}

class ImageLight : public testing::TestWithParam<bool> {};

}  // namespace

TEST(DeltaLights, PointLightIsIntensityOverSquaredDistance) {
  PointLight model;
  model.position = {1, 2, 3};
  Light light = light_of(model);
  light.scale = 7;
  const FlatScene flat = lower(scene_with({light}));
  for (const SampledLight& s : LightBench(flat).sample({1, 0, 0}, 4)) {
    EXPECT_NEAR(s.radiance, 7.0 / 13, 1e-6);
    EXPECT_EQ(s.pdf, 1);
    EXPECT_TRUE(s.delta);
    EXPECT_FALSE(s.infinite);
    EXPECT_FALSE(s.occluded);
    EXPECT_NEAR(s.wi.z, 3 / std::sqrt(13), 1e-6);
    EXPECT_EQ(s.target, glm::dvec3(1, 2, 3));
  }
}

TEST(DeltaLights, PowerOfAPointLightIsOverTheWholeSphere) {
  Light light = light_of(PointLight{});
  light.power = 100;
  const FlatScene flat = lower(scene_with({light}));
  EXPECT_NEAR(LightBench(flat).sample({0, 0, 2}, 1)[0].radiance, 100 / (4 * pi) / 4, 1e-4);
}

TEST(DeltaLights, SpotFallsOffSmoothlyBetweenItsAngles) {
  SpotLight model;
  model.direction = {0, 0, 1};
  model.total_angle = 0.5;
  model.falloff_start_angle = 0.3;
  const FlatScene flat = lower(scene_with({light_of(model)}));
  LightBench bench(flat);
  const auto at = [&](double angle) {
    return bench.sample({2 * std::sin(angle), 0, 2 * std::cos(angle)}, 1)[0];
  };
  EXPECT_NEAR(at(0.2).radiance, 0.25, 1e-6);
  const double t = (std::cos(0.4) - std::cos(0.5)) / (std::cos(0.3) - std::cos(0.5));
  EXPECT_NEAR(at(0.4).radiance, 0.25 * (3 * t * t - 2 * t * t * t), 1e-5);
  EXPECT_EQ(at(0.51).pdf, 0);
}

TEST(DeltaLights, PowerOfASpotIsWhatItsConeCarries) {
  SpotLight model;
  model.direction = {0, 0, 1};
  model.total_angle = 0.5;
  model.falloff_start_angle = 0.3;
  Light light = light_of(model);
  light.power = 10;
  const FlatScene flat = lower(scene_with({light}));
  LightBench bench(flat);
  double carried = 0;
  constexpr int steps = 400;
  for (int i = 0; i < steps; ++i) {
    const double angle = (i + 0.5) * 0.5 / steps;
    const SampledLight s = bench.sample({std::sin(angle), 0, std::cos(angle)}, 1)[0];
    carried += (s.pdf > 0 ? s.radiance : 0) * 2 * pi * std::sin(angle) * 0.5 / steps;
  }
  EXPECT_NEAR(carried, 10, 1e-3);
}

TEST(DeltaLights, DistantLightComesAgainstItsDirection) {
  DistantLight model;
  model.direction = {0, -0.6, -0.8};
  Light light = light_of(model);
  light.illuminance = 3;
  const FlatScene flat = lower(scene_with({light}));
  const SampledLight s = LightBench(flat).sample({5, 6, 7}, 1)[0];
  EXPECT_NEAR(s.radiance, 3, 1e-6);
  EXPECT_NEAR(glm::length(s.wi - glm::dvec3(0, 0.6, 0.8)), 0, 1e-6);
  EXPECT_TRUE(s.infinite);
  EXPECT_TRUE(s.delta);
}

TEST(ConstantLight, IsNeverSampledAndFoundByEveryRay) {
  Light light = light_of(InfiniteLight{});
  light.scale = 2.5;
  const FlatScene flat = lower(scene_with({light}));
  EXPECT_EQ(flat.lighting.sampled_light_count, 0u);
  LightBench bench(flat);
  EXPECT_EQ(bench.sample({0, 0, 0}, 1)[0].pdf, 0);
  for (const glm::dvec2& sky : bench.sky(sphere_directions(10))) {
    EXPECT_NEAR(sky.x, 2.5, 1e-6);
    EXPECT_EQ(sky.y, 0);
  }
}

TEST(ConstantLight, IlluminanceIsPiTimesTheRadiance) {
  Light light = light_of(InfiniteLight{});
  light.illuminance = 3;
  light.scale = 2;
  const FlatScene flat = lower(scene_with({light}));
  EXPECT_NEAR(LightBench(flat).sky({{0, 0, 1}})[0].x, 2 * 3 / pi, 1e-6);
}

TEST_P(ImageLight, ConstantImageGivesIrradiancePi) {
  const int width = 8, height = GetParam() ? 8 : 4;
  const FlatScene flat = lower(scene_with(
      {image_light(width, height, GetParam(),
                   std::vector<float>(static_cast<std::size_t>(3 * width * height), 1.f))}));
  LightBench bench(flat);
  double sum = 0, squares = 0;
  constexpr int n = 100000;
  // White in RGB is the illuminant, not 1 at every wavelength: its own value at the wavelength is
  // the unit.
  const double unit = bench.sky({{0, 0, 1}})[0].x;
  for (const SampledLight& s : bench.sample({0, 0, 0}, n)) {
    const double x = std::max(0.0, s.wi.z) * s.radiance / s.pdf / unit;
    sum += x / n;
    squares += x * x / n;
  }
  EXPECT_NEAR(sum, pi, 3 * std::sqrt((squares - sum * sum) / n));
}

TEST_P(ImageLight, ABrightTexelIsWhereTheLayoutSays) {
  const bool square = GetParam();
  const int width = square ? 16 : 32, height = 16;
  struct Place {
    int x, y;
    glm::dvec3 direction;
  };
  // Latitude-longitude: (sin t cos p, sin t sin p, cos t), p = 2 pi u, t = pi v. Square: the middle
  // is +z, the corners -z, the middles of the right and the bottom edge +x and +y.
  const double t = 2.5 / 16 * pi, p = 10.5 / 32 * 2 * pi;
  const std::vector<Place> places =
      square ? std::vector<Place>{{7, 7, {-0.1, -0.1, 1}},
                                  {15, 8, {1, 0.1, 0}},
                                  {8, 15, {0.1, 1, 0}},
                                  {15, 15, {0.1, 0.1, -1}}}
             : std::vector<Place>{
                   {10, 2, {std::sin(t) * std::cos(p), std::sin(t) * std::sin(p), std::cos(t)}},
                   {0, 8, {1, 0.1, -0.1}},
                   {8, 7, {-0.1, 1, 0.1}},
                   {3, 0, {0.05, 0.05, 1}}};
  for (const Place& place : places) {
    std::vector<float> rgb(static_cast<std::size_t>(3 * width * height), 0.f);
    for (std::size_t k = 0; k < 3; ++k)
      rgb[static_cast<std::size_t>(3 * (place.y * width + place.x)) + k] = 1;
    const FlatScene flat = lower(scene_with({image_light(width, height, square, rgb)}));
    glm::dvec3 mean(0);
    for (const SampledLight& s : LightBench(flat).sample({0, 0, 0}, 2000))
      mean += s.wi * s.radiance / s.pdf;
    // A texel and its bilinear surroundings are at most 0.3 rad wide.
    EXPECT_GT(glm::dot(glm::normalize(mean), glm::normalize(place.direction)), std::cos(0.15))
        << place.x << ' ' << place.y;
  }
}

TEST_P(ImageLight, IlluminanceReplacesTheMagnitude) {
  const int width = 16, height = GetParam() ? 16 : 8;
  Light light = image_light(width, height, GetParam(), uneven_image(width * height));
  light.illuminance = 5;
  const FlatScene flat = lower(scene_with({light}));
  LightBench bench(flat);
  const std::vector<glm::dvec3> directions = sphere_directions(100000);
  const std::vector<glm::dvec2> sky = bench.sky(directions);
  const FlatScene white = lower(scene_with({image_light(2, 1, false, std::vector<float>(6, 1.f))}));
  const double unit = LightBench(white).sky({{0, 0, 1}})[0].x;
  double e = 0;
  for (std::size_t i = 0; i < directions.size(); ++i)
    e += sky[i].x / unit * std::max(0.0, directions[i].z) * 4 * pi / 100000;
  // The host integrates over texels with the cosine at their centres: 16 of them across, an error
  // of about (pi / 16)^2 / 24.
  EXPECT_NEAR(e, 5, 0.02 * 5);
}

TEST_P(ImageLight, ABlackImageIsNotSampled) {
  const int width = 4, height = GetParam() ? 4 : 2;
  const FlatScene flat = lower(scene_with(
      {image_light(width, height, GetParam(),
                   std::vector<float>(static_cast<std::size_t>(3 * width * height), 0.f))}));
  EXPECT_EQ(flat.lighting.sampled_light_count, 0u);
  EXPECT_EQ(LightBench(flat).sky({{0, 0, 1}})[0].x, 0);
}

INSTANTIATE_TEST_SUITE_P(Layouts, ImageLight, testing::Bool(),
                         [](const testing::TestParamInfo<bool>& row) {
                           return row.param ? "square" : "latlong";
                         });

TEST(ImageLights, TwoAddUp) {
  const Light light = image_light(2, 1, false, std::vector<float>(6, 1.f));
  const double one = LightBench(lower(scene_with({light}))).sky({{0, 0, 1}})[0].x;
  EXPECT_GT(one, 0);
  EXPECT_NEAR(LightBench(lower(scene_with({light, light}))).sky({{0, 0, 1}})[0].x, 2 * one,
              1e-6 * one);
}

}  // namespace caplet::test::lights_test
