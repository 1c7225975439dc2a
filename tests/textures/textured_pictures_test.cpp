// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Pictures of textured shapes, against closed forms and pictures of more samples.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "render_scene.h"
#include "texture_trials.h"

namespace caplet::test {
namespace {

// Measured with footprints and without, and between the two.
constexpr double far_floor_error = 0.006, ball_error = 0.003;

// A plane of 8 x 8 squares of 0.2 and 0.6 fills the picture under a sky of radiance 1: each pixel
// within a square is its reflectance.
TEST(TexturedPictures, OfAFloorUnderAConstantSky) {
  const Scene scene = scene_of_text(
      "LookAt 0 0 1  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 90\nPixelFilter \"box\"\n"
      "Film \"rgb\" \"integer xresolution\" 32 \"integer yresolution\" 32\nWorldBegin\nLightSource "
      "\"infinite\" \"rgb L\" [1 1 "
      "1]\n"
      "Texture \"checks\" \"spectrum\" \"checkerboard\" \"rgb tex1\" [.2 .2 .2] \"rgb tex2\" [.6 "
      ".6 .6]\n"
      "\"float uscale\" 8 \"float vscale\" 8\nMaterial \"diffuse\" \"texture reflectance\" "
      "\"checks\"\n"
      "Shape \"bilinearmesh\" \"point3 P\" [-1 -1 0  1 -1 0  -1 1 0  1 1 0]");
  const Rendered rendered = render_model(scene, 64);
  const Mean mean = mean_of(rendered.image, "G");
  EXPECT_LT(mean.error, 2e-3);
  EXPECT_NEAR(mean.value, 0.4, 4 * mean.error + 1e-3);
  // Four pixels a square: v runs up, the rows run down; the camera sees u to the left, as pbrt's
  // are left-handed. Either way the squares along one diagonal of the picture are even and those
  // along the other odd.
  const std::vector<float>& albedo = channel(rendered.image, "albedo.G").floats;
  int dark = 0, bright = 0;
  for (std::size_t y = 0; y < 32; ++y)
    for (std::size_t x = 0; x < 32; ++x) {
      if ((x + 1) % 4 < 2 || (y + 1) % 4 < 2) continue;  // at edges, which footprints blur
      const float value = albedo[32 * y + x];
      dark += std::abs(value - 0.2f) < 2e-3f;
      bright += std::abs(value - 0.6f) < 2e-3f;
      EXPECT_NEAR(value, albedo[32 * (31 - y) + (31 - x)], 2e-3);
      EXPECT_NEAR(value + albedo[32 * y + (31 - x)], 0.8, 4e-3);
    }
  EXPECT_EQ(dark, 128);
  EXPECT_EQ(bright, 128);
}

// A wall of alpha 1/4 between the camera and a glowing sky, before a black floor: 3/4 of the sky;
// by shadow rays as well, of a light behind the wall.
TEST(TexturedPictures, OfAnAlphaLetThroughWhatItSays) {
  const std::string head =
      "LookAt 0 0 4  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 20\nPixelFilter \"box\"\n"
      "Film \"rgb\" \"integer xresolution\" 16 \"integer yresolution\" 16\nWorldBegin\n";
  const std::string wall =
      "Texture \"q\" \"float\" \"checkerboard\" \"float tex1\" .25 \"float tex2\" .25\nMaterial "
      "\"diffuse\" \"rgb reflectance\" "
      "[0 0 0]\n"
      "Shape \"bilinearmesh\" \"point3 P\" [-9 -9 2  9 -9 2  -9 9 2  9 9 2] \"texture alpha\" "
      "\"q\"\n";
  const Mean sky = mean_of(
      render_model(scene_of_text(head + "LightSource \"infinite\" \"rgb L\" [1 1 1]\n" + wall), 256)
          .image,
      "G");
  EXPECT_NEAR(sky.value, 0.75, 4 * sky.error + 1e-3);
  // A white floor lit from the camera's side of the wall: both ways are let through 3/4.
  const std::string floor =
      "LightSource \"distant\" \"point3 from\" [0 0 1] \"point3 to\" [0 0 0] \"rgb L\" [1 1 "
      "1]\nMaterial \"diffuse\" \"rgb "
      "reflectance\" [1 1 1]\n"
      "Shape \"bilinearmesh\" \"point3 P\" [-9 -9 0  9 -9 0  -9 9 0  9 9 0]\n";
  Scene bare = scene_of_text(head + floor), walled = scene_of_text(head + floor + wall);
  bare.view.integrator.max_depth = walled.view.integrator.max_depth = 1;
  const double free = mean_of(render_model(bare, 64).image, "G").value;
  const Mean lit = mean_of(render_model(walled, 512).image, "G");
  EXPECT_NEAR(lit.value / free, 0.75 * 0.75, 4 * lit.error / free + 1e-3);
}

// A plane that rises by a slope along u, or has the normals of one: lit along the bent normal it
// reflects 1 / pi of the light, and by the cosine elsewhere.
TEST(TexturedPictures, OfBumpsAreThoseOfTheirSlopes) {
  const auto brightness = [](const std::string& material, const glm::dvec3& from,
                             const ImagemapTexture* map) {
    Scene scene = scene_of_text(fmt::format(
        "LookAt 0 0 4  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 20\nPixelFilter \"box\"\n"
        "Film \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 8\nIntegrator \"path\" "
        "\"integer maxdepth\" "
        "1\nWorldBegin\n"
        "LightSource \"distant\" \"point3 from\" [{} {} {}] \"point3 to\" [0 0 0] \"rgb L\" [1 1 "
        "1]\n"
        "Texture \"u\" \"float\" \"bilerp\" \"float v00\" 0 \"float v01\" 0 \"float v10\" 2 "
        "\"float v11\" 2\n"
        "Material \"diffuse\" \"rgb reflectance\" [1 1 1] {}\n"
        "Shape \"bilinearmesh\" \"point3 P\" [-1 -1 0  1 -1 0  -1 1 0  1 1 0]\n",
        from.x, from.y, from.z, material));
    if (map) {
      scene.textures.push_back({NormalmapTexture{map->image}, false, "n", {}});
      scene.materials[0].normalmap = static_cast<std::uint32_t>(scene.textures.size() - 1);
    }
    return mean_of(render_model(scene, 64).image, "G").value;
  };
  // The height rises by 2 over u from 0 to 1, which is 2 long: at 45 degrees, so that the normal is
  // (-1, 0, 1) / sqrt(2).
  const double flat = brightness("", {0, 0, 1}, nullptr), h = std::sqrt(0.5);
  const std::string rising = "\"texture displacement\" \"u\"";
  EXPECT_NEAR(brightness(rising, {-1, 0, 1}, nullptr) / flat, 1, 2e-3);
  EXPECT_NEAR(brightness(rising, {0, 0, 1}, nullptr) / flat, h, 2e-3);
  EXPECT_NEAR(brightness(rising, {0, 1, 1}, nullptr) / flat, 0.5, 2e-3);
  // (0.36, 0.48, 0.8) as a texel: u along x, v along y.
  ImagemapTexture map;
  map.image = image_of(1, 1, 3, {0.68f, 0.74f, 0.9f});
  EXPECT_NEAR(brightness("", {0.36, 0.48, 0.8}, &map) / flat, 1, 2e-3);
  EXPECT_NEAR(brightness("", {0.36, -0.48, 0.8}, &map) / flat, 0.36 * 0.36 - 0.48 * 0.48 + 0.64,
              2e-3);
  // What is straight behind is hidden.
  EXPECT_EQ(brightness("", {0, 0, -1}, &map), 0);
}

/// Root of the mean square of differences of blocks of 4 x 4, of G.
double block_error(const LayeredImage& a, const LayeredImage& b, std::size_t width,
                   std::size_t first_row, std::size_t rows) {
  const std::vector<float>&x = channel(a, "G").floats, &y = channel(b, "G").floats;
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t row = first_row; row < first_row + rows; row += 4)
    for (std::size_t column = 0; column < width; column += 4, ++count) {
      double difference = 0;
      for (std::size_t j = 0; j < 4; ++j)
        for (std::size_t i = 0; i < 4; ++i) {
          const std::size_t at = (row + j) * width + column + i;
          difference += static_cast<double>(x[at]) - static_cast<double>(y[at]);
        }
      sum += difference * difference / 256;
    }
  return std::sqrt(sum / static_cast<double>(count));
}

constexpr const char* far_floor =
    "LookAt 0 0 1  0 10 0.6  0 0 1\nCamera \"perspective\" \"float fov\" 40\nPixelFilter \"box\"\n"
    "Film \"rgb\" \"integer xresolution\" 64 \"integer yresolution\" 64\nIntegrator \"path\" "
    "\"integer maxdepth\" 1\nWorldBegin\n"
    "LightSource \"distant\" \"point3 from\" [0 0 1] \"point3 to\" [0 0 0] \"rgb L\" [3 3 3]\n"
    "Texture \"t\" \"spectrum\" \"checkerboard\" \"rgb tex1\" [1 1 1] \"rgb tex2\" [0 0 0] "
    "\"string mapping\" \"planar\"\n"
    "Material \"diffuse\" \"texture reflectance\" \"t\"\n"
    "Shape \"bilinearmesh\" \"point3 P\" [-900 -900 0  900 -900 0  -900 900 0  900 900 0]\n";

// Without the variance, whose samples are two nets of half as many.
RenderOptions usual() {
  RenderOptions out;
  out.layers = Layers::usual();
  return out;
}

// Squares to the horizon: few samples are near what many say, by less than half of what points are
// off (without footprints 0.0136; with them 0.0034).
TEST(TexturedPictures, OfAFarFloorDoNotAlias) {
  const Scene scene = scene_of_text(far_floor);
  const LayeredImage few = render_model(scene, 16, usual()).image,
                     many = render_model(scene, 1024, usual()).image;
  const double error = block_error(few, many, 64, 28, 20);
  RecordProperty("error", std::to_string(error));
  EXPECT_LT(error, far_floor_error);
}

// The same floor in a mirror ball: cones spread where it bends (0.0024; where they do not, 0.0036;
// without footprints 0.0105).
TEST(TexturedPictures, OfAFarFloorInABall) {
  const std::string text = std::string(far_floor) +
                           "Material \"conductor\" \"float roughness\" 0\nTranslate 0 6 0.8\nShape "
                           "\"sphere\" \"float radius\" 1\n";
  Scene scene = scene_of_text(text);
  scene.view.integrator.max_depth = 2;
  const LayeredImage few = render_model(scene, 16, usual()).image,
                     many = render_model(scene, 1024, usual()).image;
  const double error = block_error(few, many, 64, 20, 24);
  EXPECT_LT(error, ball_error);
}

}  // namespace
}  // namespace caplet::test
