// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Backgrounds, views and what is drawn on previews, as a user asks for them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "film/image.h"
#include "program.h"
#include "support/data.h"

namespace caplet {
namespace {

namespace fs = std::filesystem;
using test::Result;
using testing::AllOf;
using testing::HasSubstr;
using Names = std::vector<std::string>;

const char* const two_balls = "1 1 -4 0 0 1 -1\n2 2 4 0 0 0.01 1\n3 2 4 3 0 0.01 2\n";

class Look : public testing::Test {
 protected:
  void SetUp() override { test::write_file(folder_ / "cell.swc", two_balls); }
  Result run(const Names& arguments) const { return test::run_program(arguments, folder_); }
  LayeredImage picture(const char* scene, Names more) const {
    more.insert(more.begin(),
                {"render", scene, "-q", "-o", "out.exr", "--size", "48x32", "--spp", "4"});
    const Result result = run(more);
    EXPECT_EQ(result.code, 0) << testing::PrintToString(more) << result.err;
    return read_exr(folder_ / "out.exr");
  }

  const fs::path folder_ = test::folder_with_scene();
};

// Shapes are lit as before to the bit; only what camera rays see of the sky is another.
TEST_F(Look, BackgroundsReplaceTheSkyAndNothingElse) {
  const LayeredImage sky = picture("scene.pbrt", {}),
                     white = picture("scene.pbrt", {"--background", "white"}),
                     none = picture("scene.pbrt", {"--background", "transparent"});
  const std::vector<float>& coverage = sky.find("A")->floats;
  EXPECT_EQ(white.find("A")->floats, coverage);
  EXPECT_EQ(none.find("A")->floats, coverage);
  int inside = 0, outside = 0, edge = 0;
  for (std::size_t i = 0; i < coverage.size(); ++i)
    for (const char* name : {"R", "G", "B"}) {
      const float before = sky.find(name)->floats[i], over = white.find(name)->floats[i],
                  alone = none.find(name)->floats[i];
      if (coverage[i] == 1) {
        EXPECT_EQ(over, before);
        EXPECT_EQ(alone, before);
        ++inside;
      } else if (coverage[i] == 0) {
        EXPECT_EQ(over, 1);
        EXPECT_EQ(alone, 0);
        ++outside;
      } else {
        EXPECT_NEAR(over, alone + (1 - coverage[i]), 1e-6);
        EXPECT_GT(alone, 0);
        ++edge;
      }
    }
  EXPECT_GT(inside, 100);
  EXPECT_GT(outside, 100);
  EXPECT_GT(edge, 10);
}

TEST_F(Look, WhatIsAskedForIsConvertedToo) {
  const Names asked = {"--view",       "top",           "--orthographic",
                       "--background", "#4080c0",       "--light",
                       "dramatic",     "--least-width", "3"};
  const LayeredImage direct = picture("cell.swc", asked);
  Names convert = {"convert", "cell.swc", "cell.pbrt", "-q"};
  convert.insert(convert.end(), asked.begin(), asked.end());
  const Result result = run(convert);
  EXPECT_EQ(result.code, 0) << result.err;
  const LayeredImage again = picture("cell.pbrt", {});
  for (const Channel& channel : direct.channels) {
    EXPECT_EQ(channel.floats, again.find(channel.name)->floats) << channel.name;
    EXPECT_EQ(channel.uints, again.find(channel.name)->uints) << channel.name;
  }
}

// Seen from the front the soma is at the left; the line runs to the right and then up.
TEST_F(Look, ViewsAndWidthsAreSeen) {
  const LayeredImage thin = picture("cell.swc",
                                    {"--view", "front", "--orthographic", "--least-width", "0"}),
                     wide = picture("cell.swc",
                                    {"--view", "front", "--orthographic", "--least-width", "4"});
  const auto sum = [](const LayeredImage& image) {
    double out = 0;
    for (const float share : image.find("A")->floats) out += double{share};
    return out;
  };
  // 9.01 units over 0.95 * 48 pixels; the wide line is 8 + 3 units long and 4 pixels thick, less
  // what the soma hides and with an end.
  const double pixels = 0.95 * 48 / 9.01;
  EXPECT_NEAR(sum(thin), 3.1416 * pixels * pixels + 0.02 * 10 * pixels * pixels, 6);
  EXPECT_NEAR(sum(wide), 3.1416 * pixels * pixels + 10 * pixels * 4, 25);
  const std::vector<float>& share = wide.find("A")->floats;
  // The soma's middle, 3.505 left of the content's and 1.005 below it.
  EXPECT_EQ(share[static_cast<std::size_t>(16 + 1.005 * pixels) * 48 +
                  static_cast<std::size_t>(24 - 3.505 * pixels)],
            1);
  // In the line's row at x = 1 all samples of a pixel, 1.5 to each side, meet the wide one; two
  // rows below none meets the thin one.
  const auto row = static_cast<std::size_t>(16 + 1.005 * pixels),
             column = static_cast<std::size_t>(24 + 1.495 * pixels);
  EXPECT_EQ(share[row * 48 + column], 1);
  EXPECT_LT(thin.find("A")->floats[row * 48 + column], 0.5);
  EXPECT_EQ(thin.find("A")->floats[(row + 2) * 48 + column], 0);
}

TEST_F(Look, PicksAndVerificationAreOfTheShapesAsTheyAre) {
  // A ray that misses the thin line by far less than four pixels.
  const Result hit = run({"pick", "cell.swc", "--ray", "0,0,9,0,0,-1"});
  const Result near = run({"pick", "cell.swc", "--ray", "0,0.05,9,0,0,-1", "--least-width", "8"});
  EXPECT_EQ(hit.code, 0) << hit.err;
  EXPECT_EQ(near.code, 0) << near.err;
  EXPECT_THAT(hit.out, HasSubstr("axon"));
  EXPECT_THAT(near.out, testing::Not(HasSubstr("axon")));
}

TEST_F(Look, BadWordsAreRefusedByName) {
  struct Row {
    Names arguments;
    const char* flag;
  };
  for (const Row& row :
       {Row{{"--view", "up"}, "--view"}, Row{{"--up", "q"}, "--up"},
        Row{{"--projection", "fish"}, "--projection"}, Row{{"--light", "moon"}, "--light"},
        Row{{"--background", "mauve"}, "--background"},
        Row{{"--least-width", "thick"}, "--least-width"}, Row{{"--axes"}, "--preview"},
        Row{{"--scale-bar", "3 furlongs", "--preview", "p.png"}, "--scale-bar"},
        Row{{"--outline", "0", "--preview", "p.png"}, "--outline"},
        Row{{"--depth-cue", "2", "--preview", "p.png"}, "--depth-cue"},
        Row{{"--axes", "--stereo", "1", "--preview", "p.png"}, "--stereo"}}) {
#ifndef CAPLET_WITH_OIIO
    if (std::ranges::find(row.arguments, "p.png") != row.arguments.end()) continue;
#endif
    Names arguments = {"render", "cell.swc", "-q", "-o", "out.exr"};
    arguments.insert(arguments.end(), row.arguments.begin(), row.arguments.end());
    const Result result = run(arguments);
    EXPECT_EQ(result.code, 2) << testing::PrintToString(arguments);
    EXPECT_THAT(result.err, HasSubstr(row.flag)) << testing::PrintToString(arguments);
    EXPECT_FALSE(fs::exists(folder_ / "out.exr"));
  }
#ifdef CAPLET_WITH_OIIO
  // The colours of a neuron have a legend, those of a pbrt scene have none.
  test::write_file(folder_ / "ball.pbrt", "WorldBegin\nShape \"sphere\"\n");
  const Result plain =
      run({"render", "ball.pbrt", "-q", "-o", "out.exr", "--color-bar", "--preview", "p.png"});
  EXPECT_EQ(plain.code, 2);
  EXPECT_THAT(plain.err, HasSubstr("--color-bar: the scene's colours have no legend"));
  EXPECT_FALSE(fs::exists(folder_ / "out.exr"));
#endif
}

#ifdef CAPLET_WITH_OIIO

TEST_F(Look, PreviewsAreWhiteOrTransparentThroughout) {
  EXPECT_EQ(run({"render", "scene.pbrt", "-q", "-o", "none", "--preview", "w.png", "--background",
                 "white"})
                .code,
            0);
  const TextureImage white = FileImageReader().read_texture(folder_ / "w.png", {});
  EXPECT_EQ(white.channels, 3);
  for (const std::size_t i : {0U, 1U, 2U}) EXPECT_EQ(white.bytes[i], 255);
  EXPECT_EQ(run({"render", "scene.pbrt", "-q", "-o", "none", "--preview", "t.png", "--background",
                 "transparent"})
                .code,
            0);
  const TextureImage clear = FileImageReader().read_texture(folder_ / "t.png", {});
  ASSERT_EQ(clear.channels, 4);
  EXPECT_EQ(clear.bytes[3], 0);
  EXPECT_EQ(clear.bytes[4 * (8 * 24 + 12) + 3], 255);
  const Result jpeg = run({"render", "scene.pbrt", "-q", "-o", "none", "--preview", "t.jpg",
                           "--background", "transparent"});
  EXPECT_EQ(jpeg.code, 2);
  EXPECT_THAT(jpeg.err, AllOf(HasSubstr("--preview"), HasSubstr(".png")));
}

// The layers that overlays look at are not written where no one asked for them, and the picture
// stays as it is.
TEST_F(Look, OverlaysAreOnThePreviewAlone) {
  const LayeredImage plain = picture("cell.swc", {"--layers", "none"});
  const LayeredImage drawn =
      picture("cell.swc", {"--layers", "none", "--preview", "d.png", "--scale-bar", "auto",
                           "--axes", "--outline", "--depth-cue"});
  ASSERT_EQ(drawn.channels.size(), plain.channels.size());
  for (const Channel& channel : plain.channels)
    EXPECT_EQ(channel.floats, drawn.find(channel.name)->floats) << channel.name;
  EXPECT_TRUE(fs::exists(folder_ / "d.png"));
}

#endif

}  // namespace
}  // namespace caplet
