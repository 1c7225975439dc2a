// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// What paths carry, against numbers on paper: filters with negative lobes, glass that disperses,
// shadows, surfaces that emit and such that do not.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>

#include "render_scene.h"

namespace caplet::test::paths_test {
namespace {

using std::numbers::pi;

/// `view`: LookAt and what else comes before the world; 16 x 16 pixels.
Scene scene_of(const std::string& view, const std::string& world,
               const std::string& filter = "\"box\"") {
  return scene_of_text(
      "Integrator \"path\" \"integer maxdepth\" 8\n" + view + "PixelFilter " + filter +
      "\nFilm \"rgb\" \"integer xresolution\" 16 \"integer yresolution\" 16\nWorldBegin\n" + world);
}

const std::string from_above =
    "LookAt 0 0 5  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 20\n";
const std::string ground =
    "Shape \"trianglemesh\" \"point3 P\" [-50 -50 0  50 -50 0  50 50 0  -50 50 0] \"integer "
    "indices\" [0 1 2  0 2 3]\n";
const std::string grey = "Material \"diffuse\" \"rgb reflectance\" [0.5 0.5 0.5]\n",
                  black = "Material \"diffuse\" \"rgb reflectance\" [0 0 0]\n";

/// Whites as a spectrum's XYZ and as the colour space's xy differ by up to this (relative).
constexpr double white_rounding = 2e-4;

/// Expects `value` in every channel's mean, within 4.5 standard errors and the whites' rounding.
void expect_mean(const LayeredImage& image, double value, double largest_error) {
  for (const char* name : {"R", "G", "B"}) {
    const Mean mean = mean_of(image, name);
    EXPECT_NEAR(mean.value, value, 4.5 * mean.error + white_rounding * value) << name;
    EXPECT_LE(mean.error, largest_error * value) << name << ": too few samples to tell";
  }
}

// --- The filter's sign ---

class Filters : public testing::TestWithParam<std::pair<std::string, std::string>> {};

// A plane of albedo a under irradiance E has the radiance a E / pi in every pixel, whatever the
// filter: it integrates to 1.
TEST_P(Filters, LeaveAPlaneUnderADistantLightAsItIs) {
  const Scene scene = scene_of(
      from_above,
      "LightSource \"distant\" \"rgb L\" [2 2 2] \"point3 from\" [3 0 4] \"point3 to\" [0 0 0]\n" +
          grey + ground,
      GetParam().second);
  expect_mean(render_model(scene, 512).image, 0.5 * 2 * 0.8 / pi, 5e-3);
}

INSTANTIATE_TEST_SUITE_P(Kinds, Filters,
                         testing::ValuesIn(std::vector<std::pair<std::string, std::string>>{
                             {"box", "\"box\""},
                             {"triangle", "\"triangle\""},
                             {"gaussian", "\"gaussian\""},
                             {"mitchell", "\"mitchell\""},
                             {"catmull_rom", "\"mitchell\" \"float B\" 0 \"float C\" 0.5"},
                             {"sharp", "\"mitchell\" \"float B\" 0 \"float C\" 1"}}),
                         [](const auto& row) { return row.param.first; });

// --- Dispersion ---

// An index that varies by 1e-5 bends light as a constant one does, and so must give the same
// picture: by the hero wavelength alone.
TEST(Dispersion, LosesNoLightSamples) {
  const auto picture = [](const std::string& eta) {
    const Scene scene = scene_of(
        from_above,
        "LightSource \"distant\" \"rgb L\" [3 3 3] \"point3 from\" [3 0 4] \"point3 to\" [0 0 0]\n"
        "LightSource \"distant\" \"rgb L\" [1 1 1] \"point3 from\" [2 1 -4] \"point3 to\" [0 0 0]\n"
        "Material \"dielectric\" " +
            eta + " \"bool remaproughness\" false \"float roughness\" 0.7\n" + ground);
    return render_model(scene, 4096).image;
  };
  const LayeredImage constant = picture("\"float eta\" 1.5"),
                     varying = picture("\"spectrum eta\" [360 1.49999 830 1.50001]");
  for (const char* name : {"R", "G", "B"}) {
    const Mean expected = mean_of(constant, name), mean = mean_of(varying, name);
    const double error = std::hypot(expected.error, mean.error);
    EXPECT_NEAR(mean.value, expected.value, 4.5 * error) << name;
    EXPECT_LT(error, 6e-3 * expected.value) << name << ": too few samples to tell";
  }
}

// --- Shadows ---

// A plate at 95 % of the way to the light darkens all that the camera sees; without it the ground
// has I / (pi d^2) a.
TEST(Shadows, ReachToTheLight) {
  const std::string lamp = "LightSource \"point\" \"rgb I\" [4 4 4] \"point3 from\" [0 0 4]\n";
  const std::string plate = black + "Translate 0 0 3.8\nShape \"disk\" \"float radius\" 0.19\n";
  const std::string view =
      "LookAt 1.5 0 2  0 0 0  0 0 1\nCamera \"perspective\" \"float fov\" 0.2\n";
  expect_mean(render_model(scene_of(view, lamp + grey + ground), 64).image, 0.5 / pi * 4 / 16,
              1e-3);
  EXPECT_EQ(
      mean_of(render_model(scene_of(view, lamp + grey + ground + plate), 64).image, "G").value, 0);
  // The same of a disk that shines.
  const std::string shining =
      "AttributeBegin\nAreaLightSource \"diffuse\" \"rgb L\" [5 5 "
      "5]\nReverseOrientation\nTranslate 0 0 4\n" +
      black + "Shape \"disk\" \"float radius\" 0.1\nAttributeEnd\n";
  expect_mean(render_model(scene_of(view, shining + grey + ground), 256).image,
              0.5 * 5 * 0.01 / (0.01 + 16), 1e-3);
  EXPECT_EQ(
      mean_of(render_model(scene_of(view, shining + grey + ground + plate), 64).image, "G").value,
      0);
}

// --- Surfaces that do not emit ---

TEST(DarkSurfaces, AreBlackWhereTheyAreSeen) {
  const std::string view = "LookAt 0 -5 0  0 0 0  0 0 1\nCamera \"perspective\" \"float fov\" 5\n";
  const auto face = [&](int lit) {
    const std::string box = "AreaLightSource \"diffuse\" \"rgb L\" [1 1 1] \"integer surfaces\" [" +
                            std::to_string(lit) + "]\n" + black +
                            "Shape \"box\" \"point3 p0\" [-1 -1 -1] \"point3 p1\" [1 1 1]\n";
    return mean_of(render_model(scene_of(view, box), 256).image, "G").value;
  };
  for (const int dark : {0, 1, 3, 4, 5}) EXPECT_EQ(face(dark), 0) << dark;
  EXPECT_NEAR(face(2), 1, white_rounding);  // -y, which the camera sees
}

// --- Layers ---

/// Reflectance of unpolarised light at n + i k (Born and Wolf, 14.2), by complex numbers.
double reflectance(double cos_i, std::complex<double> index) {
  const std::complex<double> cos_t = std::sqrt(1.0 - (1 - cos_i * cos_i) / (index * index));
  const std::complex<double> s = (cos_i - index * cos_t) / (cos_i + index * cos_t),
                             p = (index * cos_i - cos_t) / (index * cos_i + cos_t);
  return 0.5 * (std::norm(s) + std::norm(p));
}

TEST(AlbedoLayer, OfAMetalIsItsReflectance) {
  const std::string metal =
      "Material \"conductor\" \"spectrum eta\" [360 1.5 830 1.5] \"spectrum k\" [360 1.2 830 "
      "1.2]\n";
  for (const double theta : {0.0, 0.8, 1.3}) {
    const std::string view = "LookAt " + std::to_string(5 * std::sin(theta)) + " 0 " +
                             std::to_string(5 * std::cos(theta)) +
                             "  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 0.2\n";
    const LayeredImage image =
        render_model(scene_of(view, "LightSource \"infinite\"\n" + metal + ground), 256).image;
    for (const char* name : {"albedo.R", "albedo.G", "albedo.B"}) {
      const std::vector<float>& values = channel(image, name).floats;
      double mean = 0;
      for (const float value : values) mean += value / static_cast<double>(values.size());
      // Four wavelengths a sample, 256 samples, 256 pixels: the colour of white is known to 0.5 %.
      EXPECT_NEAR(mean, reflectance(std::cos(theta), {1.5, 1.2}), 5e-3) << name << " at " << theta;
    }
  }
}

}  // namespace
}  // namespace caplet::test::paths_test
