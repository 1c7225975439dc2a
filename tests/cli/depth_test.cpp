// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// `render --depth`: distances and planar depths by closed forms, as EXR and as PNG.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "film/image.h"
#include "pictures.h"
#include "program.h"

namespace caplet::depth_test {
namespace {

namespace fs = std::filesystem;
using test::folder_with_scene;
using test::render;
using test::Result;
using testing::ElementsAre;
using testing::HasSubstr;

// A wall across the axis of a camera that is turned, 4 units before it, of which the right part of
// the picture sees nothing. x and y of the plane at distance 1 go from -1 to 1.
constexpr const char* wall =
    "Translate 0 0 4\nRotate 30 1 0 0\nTranslate 5 -2 1\nCamera \"perspective\" \"float fov\" 90\n"
    "Film \"rgb\" \"integer xresolution\" 16 \"integer yresolution\" 16\nPixelFilter \"box\"\n"
    "Sampler \"independent\" \"integer pixelsamples\" 64\nWorldBegin\nLightSource \"infinite\"\n"
    "Translate -5 2 -1\nRotate -30 1 0 0\nTranslate -40 0 0\nShape \"box\" \"point3 p0\" [0 -40 0] "
    "\"point3 p1\" [42 40 1]\n";
constexpr int side = 16;

void expect_done(const Result& result) { ASSERT_EQ(result.code, 0) << result.err; }

double plane_of(std::size_t i) { return 2 * (static_cast<double>(i) + 0.5) / side - 1; }

TEST(Depth, IsADistanceOrAlongTheAxis) {
  const fs::path folder = folder_with_scene(wall);
  expect_done(render(folder, {"--depth", "range.exr"}));
  expect_done(render(folder, {"--depth", "planar.exr", "--depth-kind", "planar"}));
  EXPECT_THAT(test::names_in(folder), ElementsAre("planar.exr", "range.exr", "scene.pbrt"));
  const LayeredImage range = read_exr(folder / "range.exr"),
                     planar = read_exr(folder / "planar.exr");
  ASSERT_EQ(range.channels.size(), 1U);
  EXPECT_EQ(range.channels[0].name, "Z");
  EXPECT_EQ(range.metadata.at("caplet.depth"), "range");
  EXPECT_EQ(planar.metadata.at("caplet.depth"), "planar");
  for (std::size_t y = 0; y < side; ++y)
    for (std::size_t x = 0; x < side; ++x) {
      const float distance = range.channels[0].floats[side * y + x],
                  along = planar.find("Z")->floats[side * y + x];
      if (plane_of(x) > 0.5) {  // the wall ends there
        EXPECT_TRUE(std::isnan(distance) && std::isnan(along)) << x << ' ' << y;
        continue;
      }
      // Floats of points up to 15 units away, and of rays: some roundings of 1e-6.
      EXPECT_NEAR(along, 4, 1e-5);
      // 64 random places in a pixel 0.5 wide there: their mean is off by less than 5 of its
      // deviations, 0.5 / sqrt(12 * 64) each way.
      EXPECT_NEAR(distance, 4 * std::hypot(1, plane_of(x), plane_of(y)), 0.13) << x << ' ' << y;
    }
}

TEST(Depth, IsInWholeStepsOfAPng) {
  const fs::path folder = folder_with_scene(wall);
  const auto steps = [&](const std::string& name) {
    const ImageEncoding linear{ImageEncoding::Kind::linear};
    const TextureImage image = FileImageReader().read_texture(folder / name, linear);
    EXPECT_EQ(image.channels, 1);
    std::vector<double> out;
    for (const float value : image.floats) out.push_back(std::round(65535.0 * double{value}));
    return out;
  };
  expect_done(render(folder, {"--depth", "mm.png", "--depth-kind", "planar"}));
  expect_done(
      render(folder, {"--depth", "cm.png", "--depth-kind", "planar", "--depth-unit", "0.01"}));
  const std::vector<double> mm = steps("mm.png"), cm = steps("cm.png");
  for (std::size_t i = 0; i < mm.size(); ++i) {
    EXPECT_EQ(mm[i], plane_of(i % side) > 0.5 ? 0 : 4000) << i;
    EXPECT_EQ(cm[i], plane_of(i % side) > 0.5 ? 0 : 400) << i;
  }
  const Result result =
      render(folder, {"--depth", "far.png", "--depth-kind", "planar", "--depth-unit", "1e-5"});
  expect_done(result);
  EXPECT_THAT(result.err, HasSubstr("far.png: 192 of 256 pixels lie beyond 1 to 65535 steps of "
                                    "1e-05 and are 0"));
  for (const double step : steps("far.png")) EXPECT_EQ(step, 0);
}

TEST(Depth, IsOfTheCrop) {
  const fs::path folder = folder_with_scene(wall);
  expect_done(render(folder, {"--depth", "d.exr", "--depth-kind", "planar", "--crop", "2,3,14,5"}));
  const LayeredImage image = read_exr(folder / "d.exr");
  EXPECT_THAT((std::array{image.x, image.y, image.data_width, image.data_height}),
              ElementsAre(2, 3, 12, 2));
  EXPECT_NEAR(image.channels[0].floats[12], 4, 1e-5);
  EXPECT_TRUE(std::isnan(image.channels[0].floats[23]));
}

TEST(Depth, IsOfEachFrame) {
  const fs::path folder = folder_with_scene(wall);
  expect_done(
      render(folder, {"--depth", "d.####.png", "--turntable", "2", "--depth-kind", "planar"}));
  EXPECT_THAT(test::names_in(folder), ElementsAre("d.0001.png", "d.0002.png", "scene.pbrt"));
  // Frames are there with all their files.
  const std::vector<std::string> both{
      "--depth", "d.####.png", "-o", "f.####.exr", "--turntable", "2", "--skip-existing"};
  const testing::Matcher<std::vector<std::string>> all =
      ElementsAre("d.0001.png", "d.0002.png", "f.0001.exr", "f.0002.exr", "scene.pbrt");
  expect_done(render(folder, both));
  EXPECT_THAT(test::names_in(folder), all);
  fs::remove(folder / "d.0002.png");
  expect_done(render(folder, both));
  EXPECT_THAT(test::names_in(folder), all);
}

TEST(Depth, RefusesWhatItCannotTell) {
  const fs::path folder = folder_with_scene(wall);
  for (const auto& [arguments, wrong] :
       {std::pair{std::vector<std::string>{"--depth", "a.exr", "--stereo", "1"},
                  "--depth: does not go with --stereo"},
        {{"--depth", "a.jpg"}, "--depth: 'a.jpg': depth pictures are written as .exr or .png"},
        {{"--depth", "a.png", "-o", "b.####.exr", "--turntable", "2"}, "--depth: 'a.png'"},
        {{"--depth-kind", "planar"}, "--depth-kind: goes with --depth"},
        {{"--depth-unit", "1"}, "--depth-unit: goes with --depth"},
        {{"--depth", "a.exr", "--depth-unit", "1"}, "--depth-unit: goes with --depth FILE.png"},
        {{"--depth", "a.exr", "--depth-kind", "z"}, "--depth-kind"},
        {{"--depth", "a.png", "--depth-unit", "0"}, "--depth-unit"},
        {{"--depth", "a.####.exr", "--turntable", "2", "--shutter", "0.5", "--depth-kind",
          "planar"},
         "--depth-kind: planar depths need a camera that rests"}}) {
    const Result result = render(folder, arguments);
    EXPECT_EQ(result.code, 2) << wrong;
    EXPECT_THAT(result.err, HasSubstr(wrong));
  }
  EXPECT_THAT(test::names_in(folder), ElementsAre("scene.pbrt"));
}

}  // namespace
}  // namespace caplet::depth_test
