// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The image light against a sky that the test makes itself from docs/lights.md: layouts,
// interpolation, seams, density.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <memory>
#include <numbers>
#include <random>

#include "light_bench.h"
#include "light_scenes.h"
#include "support/chi_square.h"

namespace caplet::test::sky_test {

namespace {

using std::numbers::pi;

/// A grey image and what the sky is by it.
struct Sky {
  bool square;
  int width, height;
  std::vector<double> texels;

  double texel(int x, int y) const {
    if (square) {  // over the edges of the folded octahedron
      if (x < 0) return texel(-1 - x, height - 1 - y);
      if (x >= width) return texel(2 * width - 1 - x, height - 1 - y);
      if (y < 0) return texel(width - 1 - x, -1 - y);
      if (y >= height) return texel(width - 1 - x, 2 * height - 1 - y);
    }
    x = ((x % width) + width) % width;
    y = std::min(std::max(y, 0), height - 1);
    return texels[static_cast<std::size_t>(y * width + x)];
  }
  /// Radiance at u, v of the image: linear between the centres of texels along both axes.
  double at(double u, double v) const {
    const double x = u * width - 0.5, y = v * height - 0.5, s = x - std::floor(x),
                 t = y - std::floor(y);
    const int i = static_cast<int>(std::floor(x)), j = static_cast<int>(std::floor(y));
    return (1 - t) * ((1 - s) * texel(i, j) + s * texel(i + 1, j)) +
           t * ((1 - s) * texel(i, j + 1) + s * texel(i + 1, j + 1));
  }
  /// u and v of a direction in the light's space, and the steradians that a unit of the image's
  /// area has there.
  std::array<double, 3> place(const glm::dvec3& d) const {
    if (!square) {
      const double phi = std::atan2(d.y, d.x), theta = std::acos(std::clamp(d.z, -1.0, 1.0));
      return {phi / (2 * pi) + (phi < 0 ? 1 : 0), theta / pi, 2 * pi * pi * std::sin(theta)};
    }
    const double r = std::sqrt(1 - std::abs(d.z)),
                 turn = std::atan2(std::abs(d.y), std::abs(d.x)) / (pi / 2);
    double a = r * (1 - turn), b = r * turn;
    if (d.z < 0) {
      const double folded = 1 - b;
      b = 1 - a;
      a = folded;
    }
    return {0.5 + std::copysign(a, d.x) / 2, 0.5 + std::copysign(b, d.y) / 2, 4 * pi};
  }
  double radiance(const glm::dvec3& d) const {
    const auto [u, v, unused] = place(d);
    return at(u, v);
  }
  /// The integral of the radiance over each texel's cell, by the cell's solid angle and the mean
  /// over 16 x 16 of its points.
  std::vector<double> cell_weights() const {
    std::vector<double> weights;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        double mean = 0;
        for (int i = 0; i < 256; ++i)
          mean += at((x + (i % 16 + 0.5) / 16) / width, (y + (i / 16 + 0.5) / 16) / height) / 256;
        const double band =
            square ? 4 * pi / height
                   : 2 * pi * (std::cos(pi * y / height) - std::cos(pi * (y + 1) / height));
        weights.push_back(mean * band / width);
      }
    return weights;
  }
  /// By solid angle.
  double density(const glm::dvec3& d, const std::vector<double>& weights, double total) const {
    const auto [u, v, steradians] = place(d);
    const int x = std::min(static_cast<int>(u * width), width - 1),
              y = std::min(static_cast<int>(v * height), height - 1);
    return weights[static_cast<std::size_t>(y * width + x)] / total * width * height / steradians;
  }
};

Sky uneven_sky(bool square) {
  Sky sky{square, square ? 12 : 16, square ? 12 : 8, {}};
  std::mt19937 engine(5);
  for (int i = 0; i < sky.width * sky.height; ++i)
    sky.texels.push_back(std::exp(-static_cast<float>(engine() >> 8) * 0x1p-24f * 6));
  return sky;
}

const glm::dmat3 turned(glm::dvec3(0, 1, 0), glm::dvec3(0, 0, 1),
                        glm::dvec3(1, 0, 0));  // columns: x -> y, y -> z, z -> x

Light light_of(const Sky& sky) {
  std::vector<float> rgb;
  for (const double value : sky.texels) rgb.insert(rgb.end(), 3, static_cast<float>(value));
  Light light = image_light(sky.width, sky.height, sky.square, rgb);
  std::get<InfiniteLight>(light.model).world_from_light = turned;
  return light;
}

FlatScene lowered(const std::vector<Light>& lights) { return lower(scene_with(lights)); }

/// Radiance of white at the first wavelength of the bench.
double white_radiance() {
  const Sky white{false, 2, 1, {1, 1}};
  return LightBench(lowered({light_of(white)})).sky({{0, 0, 1}})[0].x;
}

std::size_t bin_of(const glm::dvec3& d) {
  const double turn = std::atan2(d.y, d.x) / (2 * pi) + 0.5;
  return static_cast<std::size_t>(std::min(static_cast<int>((d.z + 1) * 6), 11) * 24 +
                                  std::min(static_cast<int>(turn * 24), 23));
}

class ImageSky : public testing::TestWithParam<bool> {};

}  // namespace

// Radiance, and the density that light sampling has, in every direction: also on seams and near
// poles, a fifth of a texel to either side of them.
TEST_P(ImageSky, IsTheImageInEveryDirection) {
  const Sky sky = uneven_sky(GetParam());
  const std::vector<double> weights = sky.cell_weights();
  double total = 0;
  for (const double weight : weights) total += weight;
  std::vector<glm::dvec3> directions = sphere_directions(20000);
  for (int i = 0; i < 400; ++i) {
    const double angle = (i + 0.3) * pi / 400;
    for (const double off : {-0.08, -1e-3, 1e-3, 0.08}) {
      // The longitude seam (phi = 0), and the octahedron's folds: its edges lie in z = 0 and, on
      // the square's rim, x = 0 and y = 0.
      directions.push_back(glm::normalize(glm::dvec3(std::sin(angle), off, std::cos(angle))));
      directions.push_back(glm::normalize(glm::dvec3(-std::sin(angle), off, std::cos(angle))));
      directions.push_back(glm::normalize(glm::dvec3(off, std::sin(angle), std::cos(angle))));
      directions.push_back(glm::normalize(glm::dvec3(off, -std::sin(angle), std::cos(angle))));
      directions.push_back(
          glm::normalize(glm::dvec3(std::cos(2 * angle), std::sin(2 * angle), off)));
    }
  }
  std::vector<glm::dvec3> world;
  for (const glm::dvec3& d : directions) world.push_back(turned * d);
  const double unit = white_radiance();
  const std::vector<glm::dvec2> found = LightBench(lowered({light_of(sky)})).sky(world);
  int off_density = 0;
  for (std::size_t i = 0; i < directions.size(); ++i) {
    // Places in the image are right to some 1e-6, and a step between texels is at most 1: 16 texels
    // across, 2e-5 (near the poles of a latitude-longitude image u is only as good as 1e-7 / sin
    // theta: none here is nearer than 1e-3).
    EXPECT_NEAR(found[i].x / unit, sky.radiance(directions[i]), 2e-4) << i;
    // The weight that gives the density away has 1e-7 / (1 - weight): densities from 1e-2 on within
    // 1e-3. On cells' borders either.
    const double density = sky.density(directions[i], weights, total);
    if (density > 0.01 && std::abs(found[i].y - density) > 3e-3 * density) ++off_density;
  }
  EXPECT_LT(off_density, 25);
}

TEST_P(ImageSky, SamplesFollowTheDensity) {
  const Sky sky = uneven_sky(GetParam());
  const std::vector<double> weights = sky.cell_weights();
  double all = 0, flux = 0;
  for (const double weight : weights) all += weight;
  LightBench bench(lowered({light_of(sky)}));
  constexpr std::size_t sample_count = 100000, direction_count = 1000000;
  std::vector<double> expected(12 * 24, 0), observed(12 * 24, 0);
  for (const glm::dvec3& d : sphere_directions(direction_count)) {
    expected[bin_of(turned * d)] +=
        sky.density(d, weights, all) * 4 * pi / direction_count * sample_count;
    flux += sky.radiance(d) * 4 * pi / direction_count;
  }
  const double unit = white_radiance();
  double estimate = 0, squares = 0;
  for (const SampledLight& s : bench.sample({0, 0, 0}, sample_count)) {
    ASSERT_GT(s.pdf, 0);
    EXPECT_TRUE(s.infinite);
    EXPECT_FALSE(s.delta);
    const glm::dvec3 local = glm::transpose(turned) * s.wi;
    EXPECT_NEAR(s.radiance / unit, sky.radiance(local), 5e-4);
    observed[bin_of(s.wi)] += 1;
    const double x = s.radiance / unit / s.pdf;
    estimate += x / sample_count;
    squares += x * x / sample_count;
  }
  const ChiSquareResult chi = chi_square(observed, expected);
  EXPECT_GT(chi.p_value, 0.001) << chi.statistic << " / " << chi.degrees_of_freedom;
  EXPECT_NEAR(estimate, flux,
              5 * std::sqrt((squares - estimate * estimate) / sample_count) + 1e-4 * flux);
}

// Beside another light both the samples' density and that of the sky for rays that find it carry
// the chance of being chosen.
TEST_P(ImageSky, DensitiesCarryTheChanceOfTheLight) {
  const Sky sky = uneven_sky(GetParam());
  Light lamp;
  lamp.model = PointLight{};
  lamp.scale = 1e-3;
  const FlatScene alone = lowered({light_of(sky)}), two = lowered({lamp, light_of(sky)});
  const double chance = two.light_alias[1].probability;
  ASSERT_GT(chance, 0.2);
  ASSERT_LT(chance, 0.8);
  LightBench first(alone), second(two);
  const std::vector<glm::dvec3> directions = sphere_directions(500);
  const std::vector<glm::dvec2> before = first.sky(directions), after = second.sky(directions);
  for (std::size_t i = 0; i < directions.size(); ++i)
    if (before[i].y > 0.02) {
      EXPECT_NEAR(after[i].y / before[i].y, chance, 5e-3) << i;
    }
  std::size_t found = 0;
  for (const SampledLight& s : second.sample({0, 0, 0}, 2000)) {
    if (!s.infinite) continue;
    ++found;
    const double again = first.sky({s.wi})[0].y;
    if (again > 0.02) {
      EXPECT_NEAR(s.pdf / again, chance, 1e-2);
    }
    if (found == 50) break;
  }
  EXPECT_EQ(found, 50u);
}

TEST_P(ImageSky, ScaleMultiplies) {
  Light light = light_of(uneven_sky(GetParam()));
  const glm::dvec3 d = glm::normalize(glm::dvec3(1, 2, 3));
  const double once = LightBench(lowered({light})).sky({d})[0].x;
  light.scale = 3;
  EXPECT_NEAR(LightBench(lowered({light})).sky({d})[0].x, 3 * once, 1e-5 * once);
  light.illuminance = 5;
  const double with_illuminance = LightBench(lowered({light})).sky({d})[0].x;
  light.scale = 1;
  EXPECT_NEAR(with_illuminance, 3 * LightBench(lowered({light})).sky({d})[0].x,
              1e-5 * with_illuminance);
}

// The colours of an image are under the white of its own space, whatever the film's is; the film's
// stays the reference.
TEST_P(ImageSky, HasTheWhiteOfItsOwnSpace) {
  const Sky white{GetParam(), GetParam() ? 2 : 4, 2, std::vector<double>(GetParam() ? 4 : 8, 1.0)};
  Light light = light_of(white);
  const FlatScene srgb = lowered({light});
  auto image = std::make_shared<EnvironmentImage>(*std::get<InfiniteLight>(light.model).image);
  image->space = ColorSpace::aces2065_1;
  std::get<InfiniteLight>(light.model).image = image;
  const FlatScene aces = lowered({light});
  EXPECT_EQ(aces.world.illuminant_table, srgb.world.illuminant_table);
  for (std::size_t i = 0; i < 471; ++i)
    EXPECT_EQ(aces.spectrum_tables[aces.world.illuminant_table + i],
              srgb.spectrum_tables[srgb.world.illuminant_table + i]);
  // At 450 nm daylight of 6500 K has 117.008 / 100 of its value at 560 nm, that of the ACES white
  // 107.9044 / 100; both of luminance 1. The tables' integrals with the observer (5 nm sums):
  // 0.9993 of each other.
  const double ratio =
      LightBench(aces).sky({{0, 0, 1}})[0].x / LightBench(srgb).sky({{0, 0, 1}})[0].x;
  EXPECT_NEAR(ratio, 107.9044 / 117.008, 3e-3);
}

INSTANTIATE_TEST_SUITE_P(Layouts, ImageSky, testing::Bool(),
                         [](const testing::TestParamInfo<bool>& row) {
                           return row.param ? "square" : "latlong";
                         });

}  // namespace caplet::test::sky_test
