// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The choice among lights: that chances are what the sampling does, to the last random number, and
// that no light starves.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "light_bench.h"
#include "lower/detail/light_table.h"
#include "support/chi_square.h"
#include "support/thorough.h"

namespace caplet::test::selection_test {

namespace {

using std::numbers::pi;

Light point_light(double scale) {
  Light light;
  light.model = PointLight{};
  light.scale = scale;
  return light;
}

Light sun(double scale) {
  Light light;
  light.model = DistantLight{};
  light.scale = scale;
  return light;
}

/// A ball of radius 1000: the sun's power is pi (sqrt(3) 1000)^2 times its irradiance.
Scene scene_with(const std::vector<Light>& lights) {
  Scene scene;
  scene.materials.emplace_back();
  Shape ground;
  ground.geometry = SphereShape{1000};
  scene.shapes = {ground};
  scene.lights = lights;
  return scene;
}

double chance(const FlatScene& flat, std::size_t light) {
  return flat.light_alias.at(light).probability;
}

}  // namespace

// All 2^32 random numbers, counted: a light's chance is exactly the share of those that choose it.
TEST(LightSelection, EveryRandomNumberCounts) {
  Light dark;
  dark.model = InfiniteLight{};
  const std::vector<Light> lights = {point_light(3),
                                     point_light(0),
                                     point_light(0.1),
                                     point_light(2.7),
                                     sun(1e-9),
                                     point_light(1e-30),
                                     dark};
  const FlatScene flat = lower(scene_with(lights));
  ASSERT_EQ(flat.light_alias.size(), lights.size());
  // Chances are multiples of 2^-24, so 2^8 numbers in a row choose alike.
  const std::uint32_t step = thorough() ? 1 : 16;
  const std::vector<std::uint64_t> counts = LightBench(flat).all_selections(step);
  EXPECT_EQ(counts[8], 0u);
  for (std::size_t i = 0; i < lights.size(); ++i)
    EXPECT_EQ(static_cast<double>(counts[i]), chance(flat, i) * 0x1p32 / step) << i;
  EXPECT_EQ(chance(lower(scene_with({point_light(5), dark})), 0), 1);
  EXPECT_EQ(chance(lower(scene_with({point_light(5)})), 0), 1);
}

// Half by power and half evenly: 1/2 p / sum + 1/2 / n, to the grid of 2^-24. Suns, which no light
// tree holds.
TEST(LightSelection, IsHalfByPowerAndHalfEven) {
  std::vector<Light> lights;
  double total = 0;
  for (int i = 0; i < 37; ++i) {
    lights.push_back(sun(i % 5 == 0 ? 0 : std::exp(0.2 * i)));
    total += lights.back().scale;
  }
  lights.emplace_back();
  lights.back().model = InfiniteLight{};
  const FlatScene flat = lower(scene_with(lights));
  EXPECT_EQ(flat.lighting.sampled_light_count, 29u);
  for (std::size_t i = 0; i < 37; ++i)
    EXPECT_NEAR(chance(flat, i), i % 5 == 0 ? 0 : 0.5 * lights[i].scale / total + 0.5 / 29, 0x1p-23)
        << i;
  EXPECT_EQ(chance(flat, 37), 0);
}

TEST(LightSelection, ALampKeepsAQuarterBesideASun) {
  const FlatScene flat = lower(scene_with({point_light(1e-6), sun(100)}));
  EXPECT_NEAR(chance(flat, 0), 0.25, 1e-6);
}

// The even half goes to shapes as a whole: a lamp of some capsules is one, and its parts share by
// power (area).
TEST(LightSelection, PrimitivesOfAShapeShareItsPart) {
  Scene scene = scene_with({sun(100)});
  Shape lamp;
  CapsulesShape parts;
  for (int i = 0; i < 14; ++i) {
    parts.p0.emplace_back(3 * i, 0, 0);
    parts.p1.emplace_back(3 * i + 1, 0, 0);
    parts.radius0.push_back(i == 0 ? 0.5f : 0.05f);
  }
  lamp.geometry = parts;
  lamp.emission = AreaEmission{};
  scene.shapes.push_back(lamp);
  const FlatScene flat = lower(scene);
  ASSERT_EQ(flat.lights.size(), 15u);
  const double large = 2 * pi * 0.5 + 4 * pi * 0.25, small = 2 * pi * 0.05 + 4 * pi * 0.0025;
  double sum = 0;
  for (std::size_t i = 0; i < 14; ++i) sum += chance(flat, i);
  EXPECT_NEAR(sum, 0.25, 1e-4);
  EXPECT_NEAR(chance(flat, 0), 0.25 * large / (large + 13 * small), 1e-4);
  EXPECT_NEAR(chance(flat, 5), 0.25 * small / (large + 13 * small), 1e-6);
}

// More lights than the grid of 2^-24 serves well: the chances still add to 1 and none is 0, and
// choices follow them.
TEST(LightSelection, ManyLights) {
  std::vector<LightShare> shares;
  std::mt19937 engine(3);
  for (std::uint32_t i = 0; i < 100000; ++i)
    shares.push_back({std::exp(-static_cast<double>(engine() >> 8) * 0x1p-24 * 30), i / 10});
  const std::vector<AliasRecord> table = light_table(shares);
  double sum = 0;
  for (const AliasRecord& row : table) {
    EXPECT_GE(row.probability, 0x1p-32f);
    sum += row.probability;
  }
  // Chances below 2^-8 are floats without rounding.
  EXPECT_EQ(sum, 1);
  FlatScene flat = lower(scene_with({point_light(1), point_light(1)}));
  flat.light_alias = table;
  flat.lighting.light_count = 100000;
  constexpr std::size_t n = 1 << 20;
  std::vector<std::uint32_t> u;
  for (std::size_t i = 0; i < n; ++i) u.push_back(static_cast<std::uint32_t>(engine()));
  // A hundred bins of a thousand lights.
  std::vector<double> observed(100, 0), expected(100, 0);
  for (const std::uint32_t light : LightBench(flat).select(u)) observed.at(light / 1000) += 1;
  for (std::size_t i = 0; i < table.size(); ++i)
    expected[i / 1000] += table[i].probability * static_cast<double>(n);
  EXPECT_GT(chi_square(observed, expected).p_value, 0.001);
}

}  // namespace caplet::test::selection_test
