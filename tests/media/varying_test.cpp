// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Media that vary from place to place, against quadrature along rays.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include "media_scenes.h"

namespace caplet::test::varying_test {
namespace {

using std::numbers::pi;
constexpr int n = 3;

const std::vector<double> densities = {0.1, 1.9, 0.4, 0.7, 0.2, 1.1, 0.9, 0.3, 1.4,
                                       0.6, 0.2, 1.2, 0.5, 1.6, 0.1, 0.8, 1.3, 0.4,
                                       0.2, 1.5, 0.6, 1.0, 0.3, 0.9, 0.7, 0.1, 1.8};

std::string list(const std::vector<double>& values) {
  std::string out = "[";
  for (const double value : values) out += " " + std::to_string(value);
  return out + " ]";
}

/// Linear between the centres of the cells of the unit cube, and 0 outside: by the definition, one
/// axis after the other.
double between(const std::vector<double>& values, double x, double y, double z) {
  const auto cell = [&](int i, int j, int k) {
    return i < 0 || j < 0 || k < 0 || i >= n || j >= n || k >= n
               ? 0.0
               : values[static_cast<std::size_t>((k * n + j) * n + i)];
  };
  double sum = 0;
  for (int k = -1; k <= n; ++k)
    for (int j = -1; j <= n; ++j)
      for (int i = -1; i <= n; ++i) {
        const auto hat = [](double at, int center) {
          return std::max(0.0, 1 - std::abs(at * n - 0.5 - center));
        };
        sum += hat(x, i) * hat(y, j) * hat(z, k) * cell(i, j, k);
      }
  return sum;
}

/// The cube from -1 to 1, of which the grid is seen along z; its medium stands in (-1, -1, -1) to
/// (1, 1, 1).
std::string cube(const std::string& medium) {
  return "AttributeBegin\nTranslate -1 -1 -1\nScale 2 2 2\nMakeNamedMedium \"m\" " + medium +
         "\nAttributeEnd\nMaterial \"interface\"\nMediumInterface \"m\" \"\"\nShape \"box\" "
         "\"point3 p0\" [-1 -1 -1] \"point3 "
         "p1\" [1 1 1]\n";
}
std::string grid(const std::string& rest) {
  return "\"string type\" \"uniformgrid\" \"integer nx\" 3 \"integer ny\" 3 \"integer nz\" 3 "
         "\"float density\" " +
         list(densities) + " " + rest;
}
const std::string greys = "\"rgb sigma_a\" [0.6 0.6 0.6] \"rgb sigma_s\" [0 0 0] ";

/// Mean over the rays through the cube of what `of` makes of the optical depths along the ray, at
/// steps from its beginning.
template <class Of>
double mean_over_rays(double sigma, Of of) {
  constexpr int rays = 48, steps = 96;
  double sum = 0;
  for (int i = 0; i < rays; ++i)
    for (int j = 0; j < rays; ++j) {
      std::vector<double> depth = {0};
      for (int k = 0; k < steps; ++k)
        depth.push_back(depth.back() + sigma * 2 / steps *
                                           between(densities, (i + 0.5) / rays, (j + 0.5) / rays,
                                                   (k + 0.5) / steps));
      sum += of(depth);
    }
  return sum / (rays * rays);
}

TEST(UniformGrid, LetsThroughWhatItsDensityDoes) {
  const double expected =
      mean_over_rays(0.6, [](const std::vector<double>& depth) { return std::exp(-depth.back()); });
  EXPECT_TRUE(agrees(seen(parallel_view() + "WorldBegin\n" + white_sky() + cube(grid(greys)), 256),
                     expected));
  // Twice of half of it.
  EXPECT_TRUE(agrees(
      seen(
          parallel_view() + "WorldBegin\n" + white_sky() +
              cube(grid("\"rgb sigma_a\" [0.3 0.3 0.3] \"rgb sigma_s\" [0 0 0] \"float scale\" 2")),
          256),
      expected));
}

TEST(UniformGrid, WeakensShadowRays) {
  const std::string lit = parallel_view(0.9) +
                          "WorldBegin\nLightSource \"distant\" \"point3 from\" [0 0 -1] \"point3 "
                          "to\" [0 0 0] \"rgb L\" [1 1 1]\n" +
                          "Material \"diffuse\" \"rgb reflectance\" [1 1 1]\nShape "
                          "\"bilinearmesh\" \"point3 P\" [-50 -50 2 50 -50 2 -50 50 2 50 50 "
                          "2]\n";
  // There and back the same way.
  double sum = 0;
  constexpr int rays = 48;
  for (int i = 0; i < rays; ++i)
    for (int j = 0; j < rays; ++j) {
      double depth = 0;
      const double x = 0.5 + 0.45 * (2 * (i + 0.5) / rays - 1),
                   y = 0.5 + 0.45 * (2 * (j + 0.5) / rays - 1);
      for (int k = 0; k < 96; ++k) depth += 0.6 * 2 / 96 * between(densities, x, y, (k + 0.5) / 96);
      sum += std::exp(-2 * depth) / (rays * rays * pi);
    }
  EXPECT_TRUE(agrees(seen(lit + cube(grid(greys)), 512), sum, 0.01));
}

TEST(UniformGrid, Glows) {
  const auto along = [](const std::vector<double>& depth) { return 1 - std::exp(-depth.back()); };
  EXPECT_TRUE(agrees(
      seen(parallel_view() + "WorldBegin\n" + cube(grid(greys + "\"rgb Le\" [2 2 2]")), 1024),
      2 * mean_over_rays(0.6, along), 0.01));
  // "Lescale" is a grid: here 5 everywhere within half a cell of the border.
  const std::string five = "\"float Lescale\" " + list(std::vector<double>(27, 5));
  const double expected = mean_over_rays(0.6, along);
  const Mean scaled = seen(
      parallel_view(0.6) + "WorldBegin\n" + cube(grid(greys + "\"rgb Le\" [1 1 1] " + five)), 1024);
  EXPECT_GT(scaled.value, 4 * expected);
}

// Planck's law over its maximum, in pbrt-v4's units: the CIE's y by the fit of Wyman et al. 2013,
// good for a hundredth.
double planck_luminance(double kelvin) {
  const auto radiance = [&](double nm) {
    return 1 / (std::pow(nm, 5) * (std::exp(1.438776877e7 / (nm * kelvin)) - 1));
  };
  const auto lobe = [](double nm, double at, double below, double above) {
    return std::exp(-0.5 * std::pow((nm - at) * (nm < at ? below : above), 2));
  };
  double most = 0, sum = 0;
  for (double nm = 100; nm < 5000; ++nm) most = std::max(most, radiance(nm));
  for (double nm = 360; nm < 830; ++nm)
    sum += radiance(nm) / most *
           (0.821 * lobe(nm, 568.8, 0.0213, 0.0247) + 0.286 * lobe(nm, 530.9, 0.0613, 0.0322));
  return sum;
}

TEST(UniformGrid, GlowsByItsTemperature) {
  // Eight cells of twice the cube: even within it.
  const auto thick = [](const std::string& rest) {
    return parallel_view(0.5) + "WorldBegin\n" +
           cube(
               "\"string type\" \"uniformgrid\" \"integer nx\" 2 \"integer ny\" 2 \"integer nz\" 2 "
               "\"point3 p0\" [-0.5 -0.5 "
               "-0.5] \"point3 p1\" [1.5 1.5 1.5] "
               "\"float density\" [1 1 1 1 1 1 1 1] \"rgb sigma_a\" [20 20 20] \"rgb sigma_s\" [0 "
               "0 0] " +
               rest);
  };
  const auto hot =
      colors_seen(thick("\"float temperature\" [1600 1600 1600 1600 1600 1600 1600 1600] \"float "
                        "temperatureoffset\" 100 \"float temperaturescale\" 2"),
                  256);
  const auto named = colors_seen(thick("\"blackbody Le\" 3000"), 256);
  const double magnitude = planck_luminance(3000);
  for (std::size_t c = 0; c < 3; ++c)
    EXPECT_NEAR(hot[c].value / named[c].value, magnitude, 0.02 * magnitude) << c;
  const double luminance =
      0.2126 * named[0].value + 0.7152 * named[1].value + 0.0722 * named[2].value;
  EXPECT_NEAR(luminance, 1, 0.01);
}

TEST(UniformGrid, WhiteFurnace) {
  const std::string stuff =
      grid("\"rgb sigma_a\" [0 0 0] \"rgb sigma_s\" [6 2 0.7] \"float g\" 0.3");
  for (const std::string& light : {white_sky(), white_walls()})
    for (const Mean& mean :
         colors_seen(parallel_view(1, 4000) + "WorldBegin\n" + light + cube(stuff), 256))
      EXPECT_TRUE(agrees(mean, 1, 0.01)) << light;
}

TEST(RgbGrid, IsOneOfGreysWhereItsColoursAre) {
  std::vector<double> a;
  for (const double d : densities) a.insert(a.end(), 3, 0.6 * d);
  const std::string colors =
      "\"string type\" \"rgbgrid\" \"integer nx\" 3 \"integer ny\" 3 \"integer nz\" 3 \"rgb "
      "sigma_a\" " +
      list(a) + " \"rgb sigma_s\" " + list(std::vector<double>(81, 0));
  const double expected =
      mean_over_rays(0.6, [](const std::vector<double>& depth) { return std::exp(-depth.back()); });
  EXPECT_TRUE(
      agrees(seen(parallel_view() + "WorldBegin\n" + white_sky() + cube(colors), 256), expected));
  // In a colour each wavelength loses its own share: red goes through what is red.
  std::vector<double> s;
  for (const double d : densities) s.insert(s.end(), {2 * d, 0.5 * d, 3 * d});
  const std::string furnace =
      "\"string type\" \"rgbgrid\" \"integer nx\" 3 \"integer ny\" 3 \"integer nz\" 3 \"rgb "
      "sigma_a\" " +
      list(std::vector<double>(81, 0)) + " \"rgb sigma_s\" " + list(s);
  for (const Mean& mean :
       colors_seen(parallel_view(1, 4000) + "WorldBegin\n" + white_walls() + cube(furnace), 256))
    EXPECT_TRUE(agrees(mean, 1, 0.01));
}

TEST(Cloud, IsFullBelowAndEmptyAbove) {
  const std::string cloud =
      "\"string type\" \"cloud\" \"point3 p0\" [0 -1 0] \"point3 p1\" [1 2 1] \"rgb sigma_a\" [0.7 "
      "0.7 0.7] \"rgb sigma_s\" [0 0 "
      "0]";
  const auto through = [&](double y) {
    const std::string box = "MakeNamedMedium \"m\" " + cloud +
                            "\nMaterial \"interface\"\nMediumInterface \"m\" \"\"\nTranslate 0 " +
                            std::to_string(-y) +
                            " 0\nShape \"box\" \"point3 p0\" [-9 -9 -9] \"point3 p1\" [9 9 9]\n";
    return seen(parallel_view(0.01) + "WorldBegin\n" + white_sky() + "Translate -0.5 " +
                    std::to_string(-y) + " 0\n" + box,
                1024);
  };
  EXPECT_TRUE(agrees(through(-0.5), std::exp(-0.7)));
  EXPECT_NEAR(through(1).value, 1, 0.005);
  const double middle = through(0.7).value;
  EXPECT_GT(middle, std::exp(-0.7));
  EXPECT_LT(middle, 1);
}

// Two bricks of voxels, one behind the other, in the cube.
TEST(Nanovdb, LetsThroughWhatItsVoxelsDo) {
  const auto voxel = [](int x, int y, int z) {
    return x < 0 || y < 0 || z < 0 || x > 7 || y > 7 || z > 15
               ? 0.0
               : (x < 4 ? 0.1 : 1.0) * ((x * 7 + y * 3 + z * 5) % 11) / 10.0;
  };
  auto grid_of = std::make_shared<SparseGrid>();
  grid_of->bricks = {{0, 0, 0}, {0, 0, 1}};
  for (int z = 0; z < 16; ++z)
    for (int y = 0; y < 8; ++y)
      for (int x = 0; x < 8; ++x) grid_of->values.push_back(static_cast<float>(voxel(x, y, z)));
  // The voxels' cells fill the cube.
  const double sizes[] = {8, 8, 16};
  for (int k = 0; k < 3; ++k) {
    grid_of->medium_from_voxels[k][k] = 2 / sizes[k];
    grid_of->medium_from_voxels[3][k] = 1 / sizes[k] - 1;
    grid_of->box.min[k] = -1;
    grid_of->box.max[k] = 1;
  }
  double expected = 0;
  constexpr int rays = 64, steps = 160;
  for (int i = 0; i < rays; ++i)
    for (int j = 0; j < rays; ++j) {
      double depth = 0;
      for (int k = 0; k < steps; ++k) {
        const double at[] = {8 * (i + 0.5) / rays - 0.5, 8 * (j + 0.5) / rays - 0.5,
                             16 * (k + 0.5) / steps - 0.5};
        for (int c = 0; c < 8; ++c) {
          double weight = 1;
          int corner[3];
          for (int a = 0; a < 3; ++a) {
            const double low = std::floor(at[a]);
            corner[a] = static_cast<int>(low) + (c >> a & 1);
            weight *= (c >> a & 1) != 0 ? at[a] - low : 1 - (at[a] - low);
          }
          depth += 0.9 * 2 / steps * weight * voxel(corner[0], corner[1], corner[2]);
        }
      }
      expected += std::exp(-depth) / (rays * rays);
    }
  Scene scene = scene_of_text(
      parallel_view() + "WorldBegin\n" + white_sky() +
      cube(
          "\"string type\" \"homogeneous\" \"rgb sigma_a\" [0.9 0.9 0.9] \"rgb sigma_s\" [0 0 0]"));
  NanovdbMedium medium;
  medium.scattering = std::get<HomogeneousMedium>(scene.media.at(0).model).scattering;
  medium.density = grid_of;
  scene.media[0].model = medium;
  EXPECT_TRUE(agrees(seen(scene, 256), expected));
  // Moved away as a whole by its statement's transform, nothing of it is there.
  medium.world_from_medium[3] = glm::dvec4(3, 0, 0, 1);
  scene.media[0].model = medium;
  EXPECT_TRUE(agrees(seen(scene, 16), 1));
}

}  // namespace
}  // namespace caplet::test::varying_test
