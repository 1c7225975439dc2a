// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Light in media that are the same everywhere, against closed forms and quadrature.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "media_scenes.h"

namespace caplet::test {
namespace {

using std::numbers::pi;

std::string medium(const std::string& parameters) {
  return "MakeNamedMedium \"m\" \"string type\" \"homogeneous\" " + parameters + "\n";
}
std::string absorbing(double sigma) {
  return medium("\"rgb sigma_a\" [" + std::to_string(sigma) + " " + std::to_string(sigma) + " " +
                std::to_string(sigma) + "] \"rgb sigma_s\" [0 0 0]");
}
const std::string in = "Material \"interface\" MediumInterface \"m\" \"\"\n";

TEST(Transmittance, OfASlab) {
  const std::string slab = in + "Shape \"box\" \"point3 p0\" [-5 -5 0] \"point3 p1\" [5 5 0.7]\n";
  EXPECT_TRUE(
      agrees(seen(parallel_view(0.5) + "WorldBegin\n" + white_sky() + absorbing(1.5) + slab, 16),
             std::exp(-1.5 * 0.7)));
}

TEST(Transmittance, OfASphere) {
  const double expected = 1 - pi / 4 + pi / 4 * sphere_transmittance(1.3, 1);
  EXPECT_TRUE(agrees(seen(parallel_view() + "WorldBegin\n" + white_sky() + absorbing(1.3) + in +
                              "Shape \"sphere\"",
                          256),
                     expected));
}

// Seen along its axis a capsule is a sphere with a way between its halves.
TEST(Transmittance, OfACapsule) {
  const double expected = 1 - pi / 4 + pi / 4 * std::exp(-0.8 * 0.9) * sphere_transmittance(0.8, 1);
  const std::string capsule =
      in + "Shape \"capsule\" \"point3 p0\" [0 0 0] \"point3 p1\" [0 0 0.9] \"float radius\" 1\n";
  EXPECT_TRUE(
      agrees(seen(parallel_view() + "WorldBegin\n" + white_sky() + absorbing(0.8) + capsule, 256),
             expected));
}

// Shadow rays lose as much: a point light seen by a diffuse plane through a slab.
TEST(Transmittance, OfShadowRays) {
  const std::string scene = parallel_view(0.01) +
                            "WorldBegin\nLightSource \"distant\" \"point3 from\" [0 0 -1] \"point3 "
                            "to\" [0 0 0] \"rgb L\" [1 1 1]\n" +
                            "Material \"diffuse\" \"rgb reflectance\" [0.5 0.5 0.5]\nShape "
                            "\"bilinearmesh\" \"point3 P\" [-50 -50 2 50 -50 2 -50 50 2 "
                            "50 50 2]\n" +
                            absorbing(0.6) + in +
                            "Shape \"box\" \"point3 p0\" [-50 -50 0] \"point3 p1\" [50 50 0.5]\n";
  // Through the slab twice.
  EXPECT_TRUE(agrees(seen(scene, 16), 0.5 / pi * std::exp(-0.6 * 0.5 * 2), 1e-3));
}

// As pbrt's: "scale" is of absorption and of scattering.
TEST(Media, ScaleIsOfBothCoefficients) {
  const std::string slab =
      in + "Shape \"box\" \"point3 p0\" [-50 -50 0] \"point3 p1\" [50 50 0.7]\n";
  const std::string stuff =
      medium("\"rgb sigma_a\" [0.5 0.5 0.5] \"rgb sigma_s\" [0 0 0] \"float scale\" 3");
  EXPECT_TRUE(agrees(seen(parallel_view(0.5) + "WorldBegin\n" + white_sky() + stuff + slab, 16),
                     std::exp(-1.5 * 0.7)));
  // What is scattered once at most is lost: 1 - exp(-sigma d) of the light behind.
  const std::string scatters =
      medium("\"rgb sigma_a\" [0 0 0] \"rgb sigma_s\" [0.5 0.5 0.5] \"float scale\" 3");
  EXPECT_TRUE(
      agrees(seen(parallel_view(0.5, 0) + "WorldBegin\n" + white_sky() + scatters + slab, 4096, 32),
             std::exp(-1.5 * 0.7), 0.02));
}

TEST(Emission, OfASphere) {
  const std::string glowing = medium(
      "\"rgb sigma_a\" [0.9 0.9 0.9] \"rgb sigma_s\" [0 0 0] \"rgb Le\" [1 1 1] \"float Lescale\" "
      "3");
  const double expected = pi / 4 * 3 * (1 - sphere_transmittance(0.9, 1));
  EXPECT_TRUE(agrees(
      seen(parallel_view() + "WorldBegin\n" + glowing + in + "Shape \"sphere\"", 256), expected));
}

// Radiance of light scattered once, by quadrature over the disk and along each chord.
TEST(Scattering, OnceInASphere) {
  const double sigma_a = 0.3, sigma_s = 0.9, sigma_t = sigma_a + sigma_s, g = 0.4, lx = 1,
               lz = 0;  // light comes from +x
  const auto phase = [&](double cosine) {
    return (1 - g * g) / (4 * pi * std::pow(1 + g * g - 2 * g * cosine, 1.5));
  };
  double sum = 0;
  const int n = 200;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const double x = 2 * (i + 0.5) / n - 1, y = 2 * (j + 0.5) / n - 1, h2 = 1 - x * x - y * y;
      if (h2 <= 0) continue;
      const double h = std::sqrt(h2);
      for (int k = 0; k < n; ++k) {
        const double z = h * (2 * (k + 0.5) / n - 1), b = x * lx + z * lz;
        const double to_light = -b + std::sqrt(b * b + 1 - x * x - y * y - z * z);
        sum += std::exp(-sigma_t * (z + h + to_light)) * sigma_s * phase(-lz) * 2 * h / n;
      }
    }
  sum /= n * n;
  const std::string stuff =
      medium("\"rgb sigma_a\" [0.3 0.3 0.3] \"rgb sigma_s\" [0.9 0.9 0.9] \"float g\" 0.4");
  const std::string scene = parallel_view(1, 1) +
                            "WorldBegin\nLightSource \"distant\" \"point3 from\" [1 0 0] \"point3 "
                            "to\" [0 0 0] \"rgb L\" [1 1 1]\n" +
                            stuff + in + "Shape \"sphere\"";
  EXPECT_TRUE(agrees(seen(scene, 2048), sum, 0.01));
  // pbrt's depth: without a scattering there is nothing.
  EXPECT_EQ(seen(parallel_view(1, 0) + scene.substr(scene.find("WorldBegin")), 16).value, 0);
}

// What comes back from half of space, lit evenly: 1 - sqrt(1 - albedo) H(mu) (Chandrasekhar,
// Radiative Transfer, 1950, with reciprocity).
double chandrasekhar(double albedo, double mu) {
  const int n = 400;
  std::vector<double> h(n, 1.0);
  const auto at = [&](double m) {
    double integral = 0;
    for (int j = 0; j < n; ++j) {
      const double other = (j + 0.5) / n;
      integral += h[static_cast<std::size_t>(j)] * other / (m + other) / n;
    }
    return 1 / (std::sqrt(1 - albedo) + 0.5 * albedo * integral);
  };
  for (int round = 0; round < 200; ++round) {
    std::vector<double> next(n);
    for (int i = 0; i < n; ++i) next[static_cast<std::size_t>(i)] = at((i + 0.5) / n);
    // The form with the root converges with this mean (Bosma and de Rooij 1983).
    for (int i = 0; i < n; ++i)
      h[static_cast<std::size_t>(i)] =
          0.5 * (h[static_cast<std::size_t>(i)] + next[static_cast<std::size_t>(i)]);
  }
  return 1 - std::sqrt(1 - albedo) * at(mu);
}

TEST(Scattering, AlbedoOfHalfOfSpace) {
  for (const double albedo : {0.5, 0.9}) {
    const std::string stuff =
        medium("\"rgb sigma_a\" [" + std::to_string(1 - albedo) + " " + std::to_string(1 - albedo) +
               " " + std::to_string(1 - albedo) + "] \"rgb sigma_s\" [" + std::to_string(albedo) +
               " " + std::to_string(albedo) + " " + std::to_string(albedo) + "]");
    const std::string half =
        in + "Shape \"box\" \"point3 p0\" [-3000 -3000 0] \"point3 p1\" [3000 3000 2000]\n";
    EXPECT_TRUE(
        agrees(seen(parallel_view(0.01, 3000) + "WorldBegin\n" + white_sky() + stuff + half, 512),
               chandrasekhar(albedo, 1), 0.01))
        << albedo;
    const std::string askew =
        "Integrator \"volpath\" \"integer maxdepth\" 3000\nLookAt 86.60254 0 -50 0 0 0 0 1 "
        "0\nCamera \"perspective\" \"float "
        "fov\" 0.01\n";
    EXPECT_TRUE(agrees(seen(askew + "WorldBegin\n" + white_sky() + stuff + half, 512),
                       chandrasekhar(albedo, 0.5), 0.01))
        << albedo;
  }
}

// What absorbs nothing loses nothing, whatever its colour, behind an interface or glass, with a sky
// that rays find and with walls that are sampled.
TEST(Scattering, WhiteFurnace) {
  const std::string colored =
      medium("\"rgb sigma_a\" [0 0 0] \"rgb sigma_s\" [4 1 0.3] \"float g\" 0.6");
  for (const std::string& light : {white_sky(), white_walls()})
    for (const std::string material :
         {"\"interface\"", "\"dielectric\" \"float eta\" 1.4",
          "\"dielectric\" \"float eta\" 1.3 \"float roughness\" 0.02 \"bool remaproughness\" false",
          "\"dielectric\" \"spectrum eta\" \"glass-F11\""}) {
      const std::string ball =
          "Material " + material + " MediumInterface \"m\" \"\" Shape \"sphere\"\n";
      const auto rgb =
          colors_seen(parallel_view(1, 4000) + "WorldBegin\n" + light + colored + ball, 256);
      for (const Mean& mean : rgb) EXPECT_TRUE(agrees(mean, 1, 0.01)) << material << light;
    }
}

// A rough boundary loses what light does between its facets. Values are of walks through a ball of
// GGX facets of 0.5 and index 1.4, empty or with even scattering of 1 (tests/media/walks.py).
TEST(Scattering, FurnaceBehindRoughGlass) {
  const std::string rough =
      "Material \"dielectric\" \"float eta\" 1.4 \"float roughness\" 0.5 \"bool remaproughness\" "
      "false\n";
  const std::string clear =
      medium("\"rgb sigma_a\" [0 0 0] \"rgb sigma_s\" [1 1 1]") + "MediumInterface \"m\" \"\" ";
  for (const std::string& light : {white_sky(), white_walls()}) {
    const std::string view = parallel_view(1, 4000) + "WorldBegin\n" + light + rough;
    EXPECT_NEAR(seen(view + "Shape \"sphere\"\n", 256).value, 0.684, 0.004) << light;
    EXPECT_NEAR(seen(view + clear + "Shape \"sphere\"\n", 256).value, 0.675, 0.004) << light;
  }
}

// Light from straight above that comes into half of space goes out again; beside that the boundary
// reflects. Of albedos for which the part of even light that goes out is that reflectance, by walks
// (tests/media/walks.py).
TEST(Subsurface, SendsBackItsReflectance) {
  struct Walk {
    double reflectance, from_above;
  };
  for (const Walk& walk :
       {Walk{0.1, 0.0929}, {0.3, 0.2841}, {0.5, 0.4843}, {0.8, 0.7898}, {0.95, 0.9475}}) {
    const std::string value = std::to_string(walk.reflectance);
    const std::string half = "Material \"subsurface\" \"rgb reflectance\" [" + value + " " + value +
                             " " + value +
                             "] \"float eta\" 1.33 Shape \"box\" \"point3 p0\" [-3000 -3000 0] "
                             "\"point3 p1\" [3000 3000 2000]\n";
    const double mirrored = std::pow(0.33 / 2.33, 2);
    const double expected = mirrored + (1 - mirrored) * walk.from_above;
    const Mean mean = seen(parallel_view(0.01, 20000) + "WorldBegin\n" + white_sky() + half, 64);
    EXPECT_NEAR(mean.value, expected, 4 * mean.error + 0.01 * expected) << walk.reflectance;
  }
}

// What follows the refraction into it counts for nothing: with one scattering a path all of the
// light is there.
TEST(Subsurface, CountsAsOneScattering) {
  for (const double reflectance : {0.5, 0.95}) {
    const double from_above = reflectance == 0.5 ? 0.4843 : 0.9475;
    const std::string value = std::to_string(reflectance);
    const std::string half = "Material \"subsurface\" \"rgb reflectance\" [" + value + " " + value +
                             " " + value +
                             "] \"float eta\" 1.33 Shape \"box\" \"point3 p0\" [-3000 -3000 0] "
                             "\"point3 p1\" [3000 3000 2000]\n";
    const double mirrored = std::pow(0.33 / 2.33, 2);
    const double expected = mirrored + (1 - mirrored) * from_above;
    const Mean one = seen(parallel_view(0.01, 1) + "WorldBegin\n" + white_sky() + half, 64);
    EXPECT_NEAR(one.value, expected, 4 * one.error + 0.01 * expected) << reflectance;
    EXPECT_EQ(seen(parallel_view(0.01, 0) + "WorldBegin\n" + white_sky() + half, 4).value, 0);
  }
  // A ball that absorbs nothing, of any medium that says so; else each scattering counts.
  const std::string ball =
      medium("\"rgb sigma_a\" [0 0 0] \"rgb sigma_s\" [6 6 6] \"bool subsurface\" true") +
      "Material \"dielectric\" \"float eta\" 1.4 MediumInterface \"m\" \"\" Shape \"sphere\"\n";
  EXPECT_TRUE(agrees(seen(parallel_view(1, 1) + "WorldBegin\n" + white_sky() + ball, 256), 1));
  const std::string counts = std::string(ball).replace(ball.find("true"), 4, "false");
  EXPECT_LT(seen(parallel_view(1, 1) + "WorldBegin\n" + white_sky() + counts, 64).value, 0.5);
}

// What is in it counts: light that a white ball sends back has been scattered twice.
TEST(Subsurface, WhatIsWithinCounts) {
  const std::string clear =
      medium("\"rgb sigma_a\" [0 0 0] \"rgb sigma_s\" [1e-6 1e-6 1e-6] \"bool subsurface\" true");
  const std::string scene =
      "WorldBegin\n" + white_sky() + clear +
      "Material \"dielectric\" \"float eta\" 1.00001 MediumInterface \"m\" \"\" Shape \"box\" "
      "\"point3 p0\" "
      "[-90 -90 0] \"point3 p1\" [90 90 50]\n"
      "MediumInterface \"\" Material \"diffuse\" \"rgb reflectance\" [1 1 1]\n"
      "Shape \"box\" \"point3 p0\" [-20 -20 20] \"point3 p1\" [20 20 30]\n";
  EXPECT_LT(seen(parallel_view(0.1, 1) + scene, 16).value, 1e-3);
  EXPECT_TRUE(agrees(seen(parallel_view(0.1, 2) + scene, 64), 1));
}

// Light enters a mix by the part that is a subsurface: nothing is lost.
TEST(Subsurface, IsAPartOfAMix) {
  const std::string ball =
      "MakeNamedMaterial \"wax\" \"string type\" \"subsurface\" \"rgb sigma_a\" [0 0 0] \"rgb "
      "sigma_s\" [4 4 4]\n"
      "MakeNamedMaterial \"paint\" \"string type\" \"diffuse\" \"rgb reflectance\" [1 1 1]\n"
      "Material \"mix\" \"string materials\" [ \"wax\" \"paint\" ] \"float amount\" 0.4 Shape "
      "\"sphere\"\n";
  EXPECT_TRUE(agrees(seen(parallel_view(1, 4000) + "WorldBegin\n" + white_sky() + ball, 256), 1));
  // As the paint absorbs: brighter than paint alone, darker than wax alone.
  const std::string black = std::string(ball).replace(ball.find("[1 1 1]"), 7, "[0 0 0]");
  const double value =
      seen(parallel_view(0.5, 4000) + "WorldBegin\n" + white_sky() + black, 64).value;
  EXPECT_GT(value, 0.05);
  EXPECT_LT(value, 0.6);
}

}  // namespace
}  // namespace caplet::test
