// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// How wide what a camera ray takes in is, along either side of the picture: by how much an edge
// between two pixels is blurred.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "lower/lower.h"
#include "render/renderer.h"
#include "render_scene.h"
#include "support/test_device.h"

namespace caplet::test {
namespace {

// A pixel is a box of width 1 and a board's look a box of width f about its point, so that of an
// edge between two pixels each shows of the other's side the integral of f/2 - x over (0, f/2),
// over f: f / 8. A look is over twice an eighth of a pixel.
constexpr double leak = 0.25 / 8;
// One dimension of 1,024 scrambled Sobol' points in each of 16 pixels: their error is some 1e-4.
constexpr double slack = 4e-4;
constexpr int width = 16, samples = 1024;

std::string head(const std::string& camera) {
  return camera +
         "PixelFilter \"box\"\nFilm \"rgb\" \"integer xresolution\" 16 \"integer yresolution\" 16\n"
         "Integrator \"path\" \"integer maxdepth\" 2\nWorldBegin\n";
}

/// A floor at z = 0, white where x (or, `along_v`, y) is below 0 and black beyond, by its u or v.
std::string floor_with_edge(bool along_v) {
  return fmt::format(
      "Texture \"edge\" \"spectrum\" \"checkerboard\" \"float uscale\" {} \"float vscale\" {} "
      "\"float udelta\" .5 \"float "
      "vdelta\" "
      ".5\nMaterial \"diffuse\" \"texture reflectance\" \"edge\"\n"
      "Shape \"bilinearmesh\" \"point3 P\" [-9 -9 0  9 -9 0  -9 9 0  9 9 0]\n",
      along_v ? 0 : 1, along_v ? 1 : 0);
}

/// The mean share of white in the pixels on the black side of the edge, and of black in those on
/// the white side.
std::array<double, 2> leaks(const std::vector<float>& white, bool along_v) {
  std::array<double, 2> sides{};
  for (std::size_t side = 0; side < 2; ++side)
    for (std::size_t i = 0; i < width; ++i) {
      const std::size_t across = width / 2 - 1 + side;
      sides[side] +=
          static_cast<double>(white[along_v ? across * width + i : i * width + across]) / width;
    }
  if (sides[0] > sides[1]) std::swap(sides[0], sides[1]);
  return {sides[0], 1 - sides[1]};
}

// Straight down and at 60 degrees, where what is taken in is twice as long as it is wide, as pixels
// are: in pixels it is the same.
TEST(Footprints, AreAnEighthOfAPixelOnEitherSide) {
  const double sine = std::sqrt(0.75);
  const std::string parallel = "Camera \"orthographic\" \"float screenwindow\" [-1 1 -1 1]\n",
                    narrow = "Camera \"perspective\" \"float fov\" 4\n";
  for (const std::string& camera : {parallel, narrow})
    for (const bool along_v : {false, true})
      for (const bool slanted : {false, true}) {
        const double x = slanted && !along_v ? 6 * sine : 0, y = slanted && along_v ? 6 * sine : 0,
                     z = slanted ? 3 : 6;
        const std::string at = fmt::format("LookAt {} {} {}  0 0 0  0 1 0\n", x, y, z);
        const Rendered rendered = render_model(
            scene_of_text(head(at + camera) + "LightSource \"infinite\" \"rgb L\" [1 1 1]\n" +
                          floor_with_edge(along_v)),
            samples);
        const std::array<double, 2> seen =
            leaks(channel(rendered.image, "albedo.G").floats, along_v);
        const std::string where =
            camera.substr(8, 12) + (along_v ? " v" : " u") + (slanted ? " slanted" : "");
        EXPECT_NEAR(seen[0], leak, slack) << where;
        EXPECT_NEAR(seen[1], leak, slack) << where;
      }
}

// Through an interface of index 1.5 just before the camera: pixels and rays come nearer to each
// other by 1.5, so that in pixels the blur is the same. A ray that went on as in air would take
// in 1.47 times as much, one that spread by 1.5 more 2.16 times.
TEST(Footprints, NarrowWithTheirPixelsInGlass) {
  const std::string glass =
      "AttributeBegin\nMaterial \"dielectric\" \"float eta\" 1.5\nShape \"bilinearmesh\" \"point3 "
      "P\" [-9 -9 1  9 -9 1  -9 9 1  "
      "9 9 "
      "1]\nAttributeEnd\n";
  for (const bool along_v : {false, true}) {
    // Lit from within, where no shadow ray meets the interface.
    const std::string scene =
        head("LookAt 0 0 1.05  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 4\n") +
        "LightSource \"point\" \"point3 from\" [0 0 0.5]\n" + glass;
    const std::string white =
        "Material \"diffuse\" \"rgb reflectance\" [1 1 1]\n"
        "Shape \"bilinearmesh\" \"point3 P\" [-9 -9 0  9 -9 0  -9 9 0  9 9 0]\n";
    const Rendered edge =
                       render_model(scene_of_text(scene + floor_with_edge(along_v)), 4 * samples),
                   all = render_model(scene_of_text(scene + white), 4 * samples);
    std::vector<float> share = channel(edge.image, "G").floats;
    for (std::size_t i = 0; i < share.size(); ++i) share[i] /= channel(all.image, "G").floats[i];
    const std::array<double, 2> seen = leaks(share, along_v);
    // What is reflected differs in no sample, but that one in 25 is of nothing makes it as noisy as
    // 1,000 are.
    EXPECT_NEAR(seen[0], leak, 3 * slack) << along_v;
    EXPECT_NEAR(seen[1], leak, 3 * slack) << along_v;
  }
}

constexpr const char* noise_as_large_as_pixels =
    "LookAt 4 4 5  4 4 0  0 1 0\nCamera \"orthographic\" \"float screenwindow\" [-4 4 -4 "
    "4]\nPixelFilter \"box\"\n"
    "Film \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 8\nIntegrator \"path\" "
    "\"integer maxdepth\" 1\nWorldBegin\n"
    "LightSource \"infinite\" \"rgb L\" [1 1 1]\n"
    "Texture \"noise\" \"float\" \"fbm\" \"integer octaves\" 8\n"
    "Texture \"grey\" \"spectrum\" \"mix\" \"rgb tex1\" [.5 .5 .5] \"rgb tex2\" [1 1 1] \"texture "
    "amount\" \"noise\"\n"
    "Material \"diffuse\" \"texture reflectance\" \"grey\"\n"
    "Shape \"bilinearmesh\" \"point3 P\" [-1 -1 .3  9 -1 .3  -1 9 .3  9 9 .3]\n";

// Noise of eight octaves on a plane whose pixels are as large as the first octave's cells: of a ray
// an eighth as wide the first two are seen, the others not. Means over pixels by another program
// (400 x 400 points of each); of one octave, of two and of three they would be 0.0103 above and
// 0.0025 below for the first of them.
TEST(Footprints, LeaveTwoOctavesOfNoiseAsLargeAsPixels) {
  const LayeredImage image = render_model(scene_of_text(noise_as_large_as_pixels), 1024).image;
  const std::vector<float>&x = channel(image, "P.X").floats, &y = channel(image, "P.Y").floats,
        &albedo = channel(image, "albedo.G").floats;
  struct Pixel {
    double x, y, mean;
  };
  std::size_t found = 0;
  for (const Pixel& pixel :
       {Pixel{0.5, 0.5, 0.438055}, Pixel{1.5, 0.5, 0.492022}, Pixel{0.5, 1.5, 0.657186},
        Pixel{1.5, 1.5, 0.582897}, Pixel{3.5, 2.5, 0.660134}, Pixel{2.5, 3.5, 0.626240}})
    for (std::size_t i = 0; i < albedo.size(); ++i)
      if (std::abs(static_cast<double>(x[i]) - pixel.x) < 0.1 &&
          std::abs(static_cast<double>(y[i]) - pixel.y) < 0.1) {
        ++found;
        EXPECT_NEAR(albedo[i], pixel.mean, 6e-4) << pixel.x << ' ' << pixel.y;
      }
  EXPECT_EQ(found, 6u);
}

// A film of samples from scenes that ask for 1 and for 4,096 a pixel is that of one which asks for
// 16, to the bit.
TEST(Footprints, DoNotDependOnTheNumberOfSamples) {
  const auto film = [](int asked_for, std::uint32_t first, std::uint32_t count) {
    Scene scene = scene_of_text(noise_as_large_as_pixels);
    scene.view.sampler.samples_per_pixel = asked_for;
    DeviceScene on_device(test_device(), lower(scene));
    Renderer renderer(on_device, lower_view(scene));
    renderer.pass(renderer.layout().window, first, count);
    return renderer.film().read();
  };
  Film parts = film(1, 0, 8);
  parts.add(film(4096, 8, 8));
  EXPECT_TRUE(std::ranges::equal(parts.words(), film(16, 0, 16).words()));
}

}  // namespace
}  // namespace caplet::test
