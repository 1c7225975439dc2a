// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Colours of metals and whites, and lights among others, in renders whose result is known.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <glm/vec3.hpp>

#include "render_scene.h"
#include "support/data.h"

namespace caplet::test {
namespace {

std::filesystem::path written(const std::string& text) {
  auto file = temporary_folder() / "scene.pbrt";
  std::ofstream(file) << text;
  return file;
}

/// Means of R G B and their standard errors.
std::array<std::array<double, 2>, 3> means(const Picture& picture) {
  std::array<std::array<double, 2>, 3> out{};
  const double pixels = static_cast<double>(picture.rgb.size()) / 3;
  for (std::size_t i = 0; i < picture.rgb.size(); ++i) {
    out[i % 3][0] += picture.rgb[i] / pixels;
    out[i % 3][1] += picture.variance[i] / (pixels * pixels);
  }
  for (auto& channel : out) channel[1] = std::sqrt(channel[1]);
  return out;
}

/// A mirror of the material, seen straight on under a sky of radiance 1: its reflectance at normal
/// incidence.
void expect_color(const std::string& material, const glm::dvec3& color, double tolerance) {
  const Picture picture = picture_of(
      render_file(
          written("Integrator \"path\" \"integer maxdepth\" 1\nLookAt 0 0 5  0 0 0  0 1 0\n"
                  "Camera \"perspective\" \"float fov\" 2\nPixelFilter \"box\"\n"
                  "Film \"rgb\" \"integer xresolution\" 16 \"integer yresolution\" 16\nWorldBegin\n"
                  "LightSource \"infinite\" \"rgb L\" [1 1 1]\nMaterial \"conductor\" " +
                  material + " \"float roughness\" 0\nShape \"disk\" \"float radius\" 3\n"),
          1024)
          .image);
  const auto found = means(picture);
  for (int c = 0; c < 3; ++c) {
    const auto& [mean, error] = found[static_cast<std::size_t>(c)];
    EXPECT_NEAR(mean, color[c], 5 * error + tolerance) << material << ' ' << "RGB"[c];
    EXPECT_LT(error, 2e-3);
  }
}

}  // namespace

// Colours are matched to 5e-5 by their spectra, which are right to 1e-4 between the nanometres
// where k is steep; white is held at 0.9999 as by pbrt-v4.
TEST(Metals, ReflectTheReflectanceAskedFor) {
  for (const glm::dvec3& color : {glm::dvec3(1, 0.5, 0.2), glm::dvec3(0.1, 0.3, 0.9),
                                  glm::dvec3(0.5, 0.5, 0.5), glm::dvec3(1, 1, 1)})
    expect_color("\"rgb reflectance\" [" + std::to_string(color.x) + " " + std::to_string(color.y) +
                     " " + std::to_string(color.z) + "]",
                 color, 4e-4);
}

// ((n - 1)^2 + k^2) / ((n + 1)^2 + k^2) of pbrt-v4's tables, linear between their rows, under D65
// (5 nm, linear), summed with the 1931 observer at 1 nm by a program of its own; linear sRGB.
// Johnson and Christy's copper is 0.932 0.623 0.522.
TEST(Metals, AreThoseOfPbrtByItsNames) {
  const std::pair<const char*, glm::dvec3> metals[] = {
      {"Ag", {0.971510, 0.959942, 0.915305}},   {"Al", {0.913173, 0.921504, 0.924451}},
      {"Au", {1.021878, 0.782452, 0.343395}},   {"Cu", {0.955316, 0.637586, 0.538160}},
      {"CuZn", {0.909650, 0.778251, 0.422829}}, {"TiO2", {0.232243, 0.244586, 0.272676}},
      {"MgO", {0.072036, 0.073075, 0.074892}}};
  for (const auto& [name, color] : metals)
    expect_color("\"spectrum eta\" \"metal-" + std::string(name) +
                     "-eta\" \"spectrum k\" \"metal-" + name + "-k\"",
                 color, 2e-4);
  expect_color("", {0.955316, 0.637586, 0.538160}, 2e-4);  // pbrt's default is copper
}

// A closed room is as bright beside a sun over a large ground as without: the sun's power is some
// 10^11 times that of the lamp.
TEST(ManyLights, ALampInAClosedRoomDoesNotStarve) {
  const auto room = [](const std::string& lamp, const std::string& outside) {
    return written(
        "Integrator \"path\" \"integer maxdepth\" 3\nLookAt 0 -1.8 0  0 0 0  0 0 1\nCamera "
        "\"perspective\" \"float fov\" 60\n"
        "PixelFilter \"box\"\nFilm \"rgb\" \"integer xresolution\" 16 \"integer yresolution\" "
        "16\nWorldBegin\n"
        "Material \"diffuse\" \"rgb reflectance\" [.5 .5 .5]\nShape \"box\" \"point3 p0\" [-2 -2 "
        "-2] \"point3 p1\" [2 2 2]\n" +
        lamp + outside);
  };
  const std::string sun =
      "LightSource \"distant\" \"point3 from\" [1 2 3] \"point3 to\" [0 0 0] \"rgb L\" [10 10 10]\n"
      "Translate 0 0 -10 Shape \"disk\" \"float radius\" 10000\n";
  for (const std::string& lamp :
       {std::string("LightSource \"point\" \"point3 from\" [0 0.5 1.2] \"rgb I\" [1 1 1]\n"),
        std::string("AttributeBegin Translate 0 0.5 1.2 AreaLightSource \"diffuse\" \"rgb L\" [100 "
                    "100 100] Shape \"sphere\" \"float "
                    "radius\" 0.05 AttributeEnd\n")}) {
    const Picture alone = picture_of(render_file(room(lamp, ""), 256).image);
    const Picture beside = picture_of(render_file(room(lamp, sun), 256).image);
    const auto a = means(alone), b = means(beside);
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_NEAR(b[c][0], a[c][0], 5 * std::hypot(a[c][1], b[c][1]));
      // A quarter of the samples go to the lamp and count four times: sqrt(3) of themselves, over
      // 256 pixels x 256 samples.
      EXPECT_LT(b[c][1], 3 * a[c][1] + std::sqrt(3.0) / 256 * a[c][0]);
    }
    int black = 0;
    for (std::size_t i = 1; i < beside.rgb.size(); i += 3) black += beside.rgb[i] == 0;
    EXPECT_EQ(black, 0);
  }
}

// A csg shape is chosen as well: two halves of a glowing box light a floor as the whole box does.
TEST(ManyLights, ACsgLampLightsAsItsTwin) {
  const auto floor = [](const std::string& lamp) {
    return means(
        picture_of(render_file(written("Integrator \"path\" \"integer maxdepth\" 1\nLookAt 0 -3 1  "
                                       "0 0 0  0 0 1\nCamera \"perspective\" \"float "
                                       "fov\" 30\n"
                                       "PixelFilter \"box\"\nFilm \"rgb\" \"integer xresolution\" "
                                       "16 \"integer yresolution\" 16\nWorldBegin\n"
                                       "Material \"diffuse\" \"rgb reflectance\" [.5 .5 .5]\nShape "
                                       "\"disk\" \"float radius\" 2\n" +
                                       lamp),
                               256)
                       .image));
  };
  const std::string glow = "AreaLightSource \"diffuse\" \"rgb L\" [50 50 50]\n";
  const auto box =
      floor(glow + "Shape \"box\" \"point3 p0\" [-.1 -.1 2] \"point3 p1\" [.1 .1 2.1]\n");
  const auto csg = floor(
      "ObjectBegin \"a\" Shape \"box\" \"point3 p0\" [-.1 -.1 2] \"point3 p1\" [.05 .1 2.1] "
      "ObjectEnd\n"
      "ObjectBegin \"b\" Shape \"box\" \"point3 p0\" [-.05 -.1 2] \"point3 p1\" [.1 .1 2.1] "
      "ObjectEnd\n" +
      glow + "Shape \"csg\" \"string operation\" \"union\" \"string operands\" [\"a\" \"b\"]\n");
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_NEAR(csg[c][0], box[c][0], 5 * std::hypot(csg[c][1], box[c][1]));
    // By scattered rays alone one in a thousand would find it.
    EXPECT_LT(csg[c][1], 4 * box[c][1] + 1e-3 * box[c][0]);
  }
}

// A white sheet has albedo 1 under a sky whose colours are of another space than the film's, and
// the sky has its own white: in linear sRGB, that of ACES (CIE xy 0.32168, 0.33767) at luminance 1
// by the matrix of IEC 61966-2-1.
TEST(Whites, OfAnImageInAnotherSpace) {
  auto image = std::make_shared<EnvironmentImage>();
  image->width = 4;
  image->height = 2;
  image->rgb.assign(24, 1.f);
  image->space = ColorSpace::aces2065_1;
  const Rendered rendered =
      render_file(written("LookAt 0 0 5  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" "
                          "40\nPixelFilter \"box\"\nFilm \"rgb\" \"integer "
                          "xresolution\" 16 \"integer yresolution\" 16\nWorldBegin\nMaterial "
                          "\"diffuse\" \"rgb reflectance\" [1 1 1]\n"
                          "AttributeBegin Translate -5 0 0 Shape \"box\" \"point3 p0\" [0 -5 -1] "
                          "\"point3 p1\" [5 5 0] AttributeEnd\n"),
                  4096, [&](Scene& scene) {
                    Light light;
                    InfiniteLight sky;
                    sky.image = image;
                    light.model = sky;
                    scene.lights = {light};
                  });
  const double x = 0.32168 / 0.33767, z = (1 - 0.32168 - 0.33767) / 0.33767;
  const glm::dvec3 white(3.2404542 * x - 1.5371385 - 0.4985314 * z,
                         -0.9692660 * x + 1.8760108 + 0.0415560 * z,
                         0.0556434 * x - 0.2040259 + 1.0572252 * z);
  for (std::size_t c = 0; c < 3; ++c) {
    const auto& sky = channel(rendered.image, std::string(1, "RGB"[c])).floats;
    const auto& albedo = channel(rendered.image, std::string("albedo.") + "RGB"[c]).floats;
    double sky_sum = 0, albedo_sum = 0;
    int sky_count = 0, sheet_count = 0;
    for (std::size_t i = 0; i < sky.size(); ++i) {
      if (i % 16 > 9) {
        albedo_sum += albedo[i];
        ++sheet_count;
      } else if (i % 16 < 6) {
        sky_sum += sky[i];
        ++sky_count;
      }
    }
    // Four wavelengths of each sample: 80 pixels x 4,096 samples leave about 0.2 / sqrt(3 x 10^5) =
    // 4e-4.
    EXPECT_NEAR(albedo_sum / sheet_count, 1, 3e-3) << "RGB"[c];
    EXPECT_NEAR(sky_sum / sky_count, white[static_cast<int>(c)], 3e-3) << "RGB"[c];
  }
}

}  // namespace caplet::test
