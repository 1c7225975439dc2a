// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Pictures of curves that textures and emission colour along them, against pbrt's u and v of a
// straight curve in closed form.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "render_scene.h"
#include "support/test_device.h"

namespace caplet::test {
namespace {

constexpr int size = 32;

/// From above, x from 1 on the left to -1 on the right (pbrt's axes are left-handed), y from 1 at
/// the top to -1.
std::string from_above(const std::string& world) {
  return fmt::format(
      "LookAt 0 0 4  0 0 0  0 1 0\nCamera \"orthographic\" \"float screenwindow\" [-1 1 -1 "
      "1]\nPixelFilter \"box\"\n"
      "Film \"rgb\" \"integer xresolution\" {0} \"integer yresolution\" {0}\nIntegrator \"path\" "
      "\"integer maxdepth\" 1\n"
      "WorldBegin\nLightSource \"infinite\" \"rgb L\" [1 1 1]\n{1}",
      size, world);
}

const std::string ramp =
    "Texture \"ramp\" \"spectrum\" \"bilerp\" \"rgb v00\" [.1 .1 .1] \"rgb v10\" [.5 .5 .5] \"rgb "
    "v01\" [.3 .3 .3] \"rgb v11\" "
    "[.7 .7 .7]\n"
    "Material \"diffuse\" \"texture reflectance\" \"ramp\"\n";

/// The albedo is 0.1 + 0.4 u + 0.2 v on the curve along x from `begin` to `end`, y = 0, of this
/// width. mirrored: its space is.
void expect_ramp(const Scene& scene, double begin, double end, double width,
                 bool mirrored = false) {
  const Rendered rendered = render_model(scene, 64);
  const std::vector<float>& albedo = channel(rendered.image, "albedo.G").floats;
  int seen = 0;
  for (int row = 0; row < size; ++row)
    for (int column = 0; column < size; ++column) {
      const double x = 1 - 2 * (column + 0.5) / size, y = 1 - 2 * (row + 0.5) / size,
                   half = 1.0 / size;
      if (std::abs(y) + half > width / 2 || x - half < std::min(begin, end) ||
          x + half > std::max(begin, end))
        continue;
      ++seen;
      // Rays run down: d x t is -y where the curve runs towards +x, and +y where it runs towards
      // -x.
      const double u = (x - begin) / (end - begin),
                   v = 0.5 + ((end > begin) != mirrored ? -y : y) / width;
      // The mean over a pixel of 64 samples that are stratified to 1/8 of it; grey colours as
      // spectra are within 1e-3.
      EXPECT_NEAR(albedo[static_cast<std::size_t>(size * row + column)], 0.1 + 0.4 * u + 0.2 * v,
                  3e-3)
          << column << " " << row;
    }
  EXPECT_GT(seen, size * size / 4);
}

TEST(TexturedCurves, AreColouredByPbrtsUAndV) {
  const std::string straight = ramp +
                               "Shape \"curve\" \"string type\" \"{}\" \"point3 P\" [{} 0 0 {} 0 0 "
                               "{} 0 0 {} 0 0] \"float width\" .8 {}\n";
  for (const char* more : {"", "\"integer splitdepth\" 5"}) {
    expect_ramp(scene_of_text(from_above(
                    fmt::format(fmt::runtime(straight), "flat", -1, -1 / 3.0, 1 / 3.0, 1, more))),
                -1, 1, 0.8);
    expect_ramp(scene_of_text(from_above(fmt::format(fmt::runtime(straight), "cylinder", 1, 1 / 3.0,
                                                     -1 / 3.0, -1, more))),
                1, -1, 0.8);
  }
}

// As instances, under a transform that mirrors or is no similarity: v is pbrt's in the curve's own
// space, and follows it.
TEST(TexturedCurves, OfInstancesKeepTheirOwn) {
  const std::string object = ramp +
                             "ObjectBegin \"o\"\nShape \"curve\" \"point3 P\" [0 -3 0 0 -1 0 0 1 0 "
                             "0 3 0] \"float width\" .4\nObjectEnd\n";
  // The curve's +y goes to +x; its own x to +y or -y. From above a ray runs down in it as well.
  const auto placed = [&](const char* matrix) {
    return scene_of_text(from_above(object + "Transform [" + matrix + "]\nObjectInstance \"o\"\n"));
  };
  // y -> x / 3, x -> -2 y (a rotation and a stretch): the world's ends -1 and 1, width 0.8.
  expect_ramp(placed("0 -2 0 0  0.333333333 0 0 0  0 0 1 0  0 0 0 1"), -1, 1, 0.8);
  expect_ramp(placed("0 2 0 0  0.333333333 0 0 0  0 0 1 0  0 0 0 1"), -1, 1, 0.8, true);
  const std::string shape =
      "\nShape \"curve\" \"point3 P\" [-1 0 0 -.333333 0 0 .333333 0 0 1 0 0] \"float width\" .8\n";
  expect_ramp(scene_of_text(from_above(ramp + "Scale 1 -1 1" + shape)), -1, 1, 0.8, true);
  expect_ramp(scene_of_text(from_above(ramp + "Rotate 180 0 0 1" + shape)), 1, -1, 0.8);
}

// A glowing curve seen directly: its image over u and v.
TEST(TexturedCurves, GlowAlongThem) {
  Scene scene = scene_of_text(
      from_above("Material \"diffuse\" \"rgb reflectance\" [0 0 0]\nAreaLightSource "
                 "\"diffuse\"\nShape \"curve\" "
                 "\"point3 P\" [-1 0 0 -.333333 0 0 .333333 0 0 1 0 0] \"float width\" .8\n"));
  auto image = std::make_shared<EnvironmentImage>();
  image->width = 2;
  image->height = 1;
  image->rgb = {1, 1, 1, 3, 3, 3};
  scene.shapes[0].emission->image = image;
  const Rendered rendered = render_model(scene, 64);
  const std::vector<float>& green = channel(rendered.image, "G").floats;
  for (int column = 1; column + 1 < size; ++column) {
    const double u = 0.5 * (2 - 2 * (column + 0.5) / size);
    // Linear between the middles of the texels.
    const double expected = 1 + 2 * std::clamp(2 * u - 0.5, 0.0, 1.0);
    EXPECT_NEAR(green[static_cast<std::size_t>(size * size / 2 + column)], expected, 0.02)
        << column;
  }
}

// Rays pass where an alpha along the curve is 0.
TEST(TexturedCurves, LetRaysThroughAlongThem) {
  const Scene scene =
      scene_of_text(from_above("Texture \"half\" \"float\" \"checkerboard\" \"float uscale\" 2 "
                               "\"float vscale\" .5 \"float tex1\" 0 \"float tex2\" 1\n"
                               "Material \"diffuse\" \"rgb reflectance\" [0 0 0]\nShape \"curve\" "
                               "\"point3 P\" [-1 0 0 -.333333 0 0 .333333 0 0 1 0 0] "
                               "\"float width\" .8 \"texture alpha\" \"half\"\n"));
  const Rendered rendered = render_model(scene, 16);
  const std::vector<float>& green = channel(rendered.image, "G").floats;
  for (int column = 1; column + 1 < size; ++column) {
    const double u = 0.5 * (2 - 2 * (column + 0.5) / size);
    if (std::abs(u - 0.5) < 0.05) continue;
    EXPECT_NEAR(green[static_cast<std::size_t>(size * size / 2 + column)], u < 0.5 ? 1 : 0, 0.02)
        << column;
  }
}

// Hair lies along its chain as along a capsule: the same light comes from it, and another where u,
// and with it the scales, runs back.
TEST(TexturedCurves, OfHairLieAlongThem) {
  const auto mean = [](const std::string& u) {
    const Scene scene = scene_of_text(
        "LookAt 1 -2 1.5  0 0 0.15  0 0 1\nCamera \"perspective\" \"float fov\" 3\nFilm \"rgb\" "
        "\"integer xresolution\" 8 "
        "\"integer yresolution\" 8\nIntegrator \"path\" \"integer maxdepth\" 1\nWorldBegin\n"
        "LightSource \"distant\" \"point3 from\" [2 -1 1] \"point3 to\" [0 0 0] \"rgb L\" [1 1 1]\n"
        "Material \"hair\" \"rgb reflectance\" [.8 .8 .8] \"float beta_m\" .25 \"float alpha\" 8\n"
        "Shape \"capsule\" \"point3 p0\" [-1 0 0] \"point3 p1\" [1 0 0.3] \"float radius\" .1 " +
        u);
    return mean_of(render_model(scene, 512).image, "G");
  };
  const Mean plain = mean(""), chain = mean("\"float u\" [0 1]"), back = mean("\"float u\" [1 0]");
  EXPECT_GT(plain.value, 100 * plain.error);
  EXPECT_NEAR(chain.value, plain.value, 4 * (plain.error + chain.error));
  EXPECT_GT(std::abs(back.value - plain.value), 8 * (plain.error + back.error));
}

}  // namespace
}  // namespace caplet::test
