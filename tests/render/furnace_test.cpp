// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Furnaces: scenes in which the radiance is known everywhere, whatever a path meets on its way.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numeric>
#include <random>

#include "render_scene.h"
#include "support/data.h"

namespace caplet::test {
namespace {

struct Furnace {
  std::string world;
  double radiance = 1;
  int max_depth = 100, samples = 64;
};

/// A closed room of triangles around the camera, their normals inward.
const std::string room =
    "Shape \"trianglemesh\" \"point3 P\" [-2 -5 -2  2 -5 -2  2 2 -2  -2 2 -2  -2 -5 2  2 -5 2  2 2 "
    "2  -2 2 2]\n"
    "\"integer indices\" [0 1 2  0 2 3   5 4 7  5 7 6   4 0 3  4 3 7   1 5 6  1 6 2   4 5 1  4 1 0 "
    "  3 2 6  3 6 7]\n";

/// Renders, and expects every channel's mean to four standard errors and half a percent.
LayeredImage check(const Furnace& furnace) {
  const auto file = temporary_folder() / "furnace.pbrt";
  std::ofstream(file)
      << "Integrator \"path\" \"integer maxdepth\" " << furnace.max_depth
      << "\nLookAt 0 -4 0.4  0 0 0  0 0 1\nCamera \"perspective\" \"float fov\" 30\nPixelFilter "
         "\"box\"\n"
         "Film \"rgb\" \"integer xresolution\" 32 \"integer yresolution\" 32\nWorldBegin\n"
      << furnace.world;
  const Rendered rendered = render_file(file, furnace.samples);
  for (const char* name : {"R", "G", "B"}) {
    const std::vector<float>& values = channel(rendered.image, name).floats;
    const std::vector<float>& variances =
        channel(rendered.image, std::string("variance.") + name).floats;
    const auto pixels = static_cast<double>(values.size());
    const double mean = std::accumulate(values.begin(), values.end(), 0.0) / pixels;
    const double error =
        std::sqrt(std::accumulate(variances.begin(), variances.end(), 0.0)) / pixels;
    EXPECT_NEAR(mean, furnace.radiance, 4 * error + 5e-3 * furnace.radiance) << name;
    EXPECT_LT(error, 0.01 * furnace.radiance) << name;
  }
  return rendered.image;
}

// A path through dispersive glass keeps only the hero wavelength, which counts for all four.
TEST(Furnace, DispersiveGlassTakesNothing) {
  check(
      {"LightSource \"infinite\" \"rgb L\" [1 1 1]\nMaterial \"dielectric\" \"spectrum eta\" "
       "\"glass-SF11\"\n"
       "Shape \"capsule\" \"point3 p0\" [-0.5 0 0] \"point3 p1\" [0.5 0 0] \"float radius\" 0.7\n",
       1, 100, 256});
}

// Black lights of radiance 1 in a room with 0.4 + 0.6 L = 1: each instance is sampled, and
// weighted, where it stands.
TEST(Furnace, EveryInstanceHasLightsOfItsOwn) {
  const LayeredImage image =
      check({"ObjectBegin \"lamp\" AreaLightSource \"diffuse\" \"rgb L\" [1 1 1] Material "
             "\"diffuse\" \"rgb reflectance\" [0 0 0]\n"
             "Shape \"capsule\" \"point3 p0\" [-0.2 0 0] \"point3 p1\" [0.2 0 0] \"float radius\" "
             "0.2 ObjectEnd\n"
             "AttributeBegin Translate -1.5 1 0 Scale 1 1 3 ObjectInstance \"lamp\" AttributeEnd\n"
             "AttributeBegin Translate 0.5 0 -1.2 ObjectInstance \"lamp\" AttributeEnd\n"
             "AttributeBegin Translate 1.4 0.5 0.8 Rotate 90 0 0 1 Scale 2 1 1 ObjectInstance "
             "\"lamp\" AttributeEnd\n"
             "AreaLightSource \"diffuse\" \"rgb L\" [0.4 0.4 0.4] Material \"diffuse\" \"rgb "
             "reflectance\" [0.6 0.6 0.6]\n" +
             room});
  for (const float coverage : channel(image, "A").floats) EXPECT_EQ(coverage, 1);
}

// Emission 1, albedo 1/2: every scattering adds half of the last one's light.
TEST(Furnace, DepthIsTheNumberOfScatterings) {
  const std::string world =
      "AreaLightSource \"diffuse\" \"rgb L\" [1 1 1] Material \"diffuse\" \"rgb reflectance\" [0.5 "
      "0.5 0.5]\n" +
      room;
  check({world, 1, 0});
  check({world, 1.5, 1});
  check({world, 1.75, 2});
}

// Trees of a thousand nodes make it worth while to sort paths: 0.5 + 0.5 L = 1 on all of the
// capsules.
TEST(Furnace, SortedPathsAreAllThere) {
  const auto file = temporary_folder() / "many.capsules";
  {
    std::ofstream out(file);
    std::mt19937 engine(3);
    std::uniform_real_distribution<double> u(-1, 1);
    for (int i = 0; i < 60000; ++i) {
      const double x = u(engine), y = u(engine), z = u(engine);
      out << '<' << x << ", " << y << ", " << z << "> <" << x + 0.04 * u(engine) << ", "
          << y + 0.04 * u(engine) << ", " << z + 0.04 * u(engine) << "> 0.01\n";
    }
  }
  check(
      {"LightSource \"infinite\" \"rgb L\" [1 1 1]\n"
       "AreaLightSource \"diffuse\" \"rgb L\" [0.5 0.5 0.5] Material \"diffuse\" \"rgb "
       "reflectance\" [0.5 0.5 0.5]\n"
       "Shape \"capsules\" \"string filename\" \"" +
           file.string() + "\"\n",
       1, 100, 32});
}

}  // namespace
}  // namespace caplet::test
