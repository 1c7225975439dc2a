// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Commands on scenes without shapes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "film/image.h"
#include "program.h"
#include "support/data.h"

namespace caplet {
namespace {

namespace fs = std::filesystem;
using test::Result;
using testing::HasSubstr;

constexpr const char* sky =
    "LookAt 0 0 5  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 40\n"
    "Film \"rgb\" \"integer xresolution\" 24 \"integer yresolution\" 16\nSampler \"zsobol\" "
    "\"integer pixelsamples\" "
    "4\nWorldBegin\n"
    "LightSource \"infinite\" \"rgb L\" [1 1 1]\n";

TEST(SkyScenes, AreRenderedByEveryCommand) {
  const fs::path folder = test::folder_with_scene(sky);
  const auto ran = [&](const std::vector<std::string>& arguments) {
    const Result result = test::run_program(arguments, folder);
    EXPECT_EQ(result.code, 0) << arguments[0] << ": " << result.err;
    return result;
  };
  ran({"render", "scene.pbrt", "-o", "sky.exr", "--preview", "sky.png"});
  double sum = 0;
  const LayeredImage image = read_exr(folder / "sky.exr");
  for (const Channel& channel : image.channels)
    if (channel.name == "G")
      for (const float value : channel.floats) sum += static_cast<double>(value) / (24 * 16);
  EXPECT_NEAR(sum, 1, 0.02);  // 1,536 samples of four wavelengths: 0.004
  EXPECT_TRUE(fs::exists(folder / "sky.png"));

  EXPECT_THAT(ran({"info", "scene.pbrt"}).out, HasSubstr("bounds       none"));
  const auto info = nlohmann::json::parse(ran({"info", "scene.pbrt", "--json"}).out);
  EXPECT_TRUE(info.at("bounds").is_null());
  EXPECT_TRUE(info.at("primitives").empty());
  EXPECT_EQ(info.at("lights"), 1);

  EXPECT_THAT(ran({"pick", "scene.pbrt", "--pixel", "3,4"}).out, HasSubstr("nothing"));
  ran({"pick", "scene.pbrt", "--pixel", "3,4", "--all", "--json", "--reference"});

  EXPECT_THAT(ran({"verify", "scene.pbrt", "--rays", "1000"}).out,
              HasSubstr("nothing to verify: the scene has no shapes"));
  const auto verified = nlohmann::json::parse(ran({"verify", "scene.pbrt", "--json"}).out);
  EXPECT_EQ(verified.at("rays"), 0);
  EXPECT_THAT(verified.at("verdict").get<std::string>(), HasSubstr("nothing to verify"));
  ran({"verify", "scene.pbrt", "--heatmap", "heat.exr"});

  // Written and read again: the same picture.
  ran({"convert", "scene.pbrt", "again.pbrt"});
  ran({"render", "again.pbrt", "-o", "again.exr"});
  const LayeredImage again = read_exr(folder / "again.exr");
  ASSERT_EQ(again.channels.size(), image.channels.size());
  for (std::size_t i = 0; i < image.channels.size(); ++i) {
    EXPECT_EQ(again.channels[i].floats, image.channels[i].floats) << image.channels[i].name;
    EXPECT_EQ(again.channels[i].uints, image.channels[i].uints) << image.channels[i].name;
  }

  // Turned, seen from a side, before a colour, for two eyes, and with what is drawn on it.
  ran({"render", "scene.pbrt", "--turntable", "2", "-o", "turn.##.png", "--size", "12x8"});
  ran({"render", "scene.pbrt", "--view", "left", "--projection", "orthographic", "-o", "left.png"});
  ran({"render", "scene.pbrt", "--background", "transparent", "--axes", "--outline", "--depth-cue",
       "-o", "clear.png"});
  ran({"render", "scene.pbrt", "--stereo", "0.1", "-o", "eyes.exr"});
  const Result bar =
      test::run_program({"render", "scene.pbrt", "--scale-bar", "-o", "bar.png"}, folder);
  EXPECT_EQ(bar.code, 2);
  EXPECT_THAT(bar.err, HasSubstr("no shapes that a bar could measure"));
}

// A camera alone shows black, and a warning says why; without it there is nothing at all.
TEST(SkyScenes, OfNothingAreBlackOrAnError) {
  const fs::path folder = test::folder_with_scene(
      "Camera \"perspective\"\nFilm \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" "
      "8\nWorldBegin\n");
  const Result black =
      test::run_program({"render", "scene.pbrt", "-o", "black.exr", "--spp", "1"}, folder);
  EXPECT_EQ(black.code, 0) << black.err;
  EXPECT_THAT(black.err, HasSubstr("the scene has no light: its picture is black"));
  for (const Channel& channel : read_exr(folder / "black.exr").channels)
    if (channel.name == "R" || channel.name == "G" || channel.name == "B") {
      for (const float value : channel.floats) EXPECT_EQ(value, 0);
    }
  const Result nothing = test::run_program({"render", "scene.pbrt", "-o", "no.exr"},
                                           test::folder_with_scene("WorldBegin\n"));
  EXPECT_EQ(nothing.code, 2);
  EXPECT_THAT(
      nothing.err,
      HasSubstr("scene.pbrt: the scene is empty: it has no shapes, no light and no camera"));
}

}  // namespace
}  // namespace caplet
