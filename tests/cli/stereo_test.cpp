// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// `render --stereo`: each view is what a camera moved by hand renders; and `render --display`, with
// a server in tev's place.
#include <ImfInputFile.h>
#include <ImfMultiView.h>
#include <ImfStandardAttributes.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <set>

#include "film/image.h"
#include "film/preview.h"
#include "program.h"
#include "support/data.h"
#include "support/tev_server.h"

namespace caplet {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// A ball at the origin, 5 away, and one behind it; half of the shorter side is 1 at distance 2
/// (fov 53.13...), 24 x 16 pixels.
std::string scene_from(const std::string& camera) {
  return camera +
         "Film \"rgb\" \"integer xresolution\" 24 \"integer yresolution\" 16\nSampler "
         "\"independent\" \"integer pixelsamples\" "
         "4\n"
         "WorldBegin\nLightSource \"infinite\"\nShape \"sphere\"\nTranslate 1 0.5 3 Shape "
         "\"sphere\"\n";
}
const std::string fov = " \"float fov\" 53.13010235415598";  // 2 atan(1/2)

LayeredImage rendered(const std::filesystem::path& folder, const std::string& text) {
  test::write_file(folder / "by_hand.pbrt", text);
  EXPECT_EQ(test::run_program(
                {"render", "by_hand.pbrt", "-q", "--layers", "all", "-o", "by_hand.exr"}, folder)
                .code,
            0);
  return read_exr(folder / "by_hand.exr");
}

void expect_view(const LayeredImage& both, const std::vector<std::string>& views, std::size_t view,
                 const LayeredImage& alone) {
  EXPECT_EQ(both.channels.size(), 2 * alone.channels.size());
  for (const Channel& channel : alone.channels) {
    const Channel* found = both.find(name_in_view(channel.name, views, view));
    ASSERT_NE(found, nullptr) << channel.name;
    EXPECT_EQ(found->floats, channel.floats) << channel.name;
    EXPECT_EQ(found->uints, channel.uints) << channel.name;
  }
}

TEST(Stereo, ViewsAreThoseOfCamerasMovedByHand) {
  const auto folder = test::folder_with_scene(
      scene_from("LookAt 0 0 -5 0 0 0 0 1 0\nCamera \"perspective\"" + fov + "\n"));
  const std::vector<std::string> views = {"left", "right"};
  // The camera's right is +x.
  const auto by_hand = [&](const char* x, const std::string& window) {
    const std::string from = std::string(x) + " 0 -5 ", to = std::string(x) + " 0 0 ";
    return rendered(folder, scene_from("LookAt " + from + to + "0 1 0\nCamera \"perspective\"" +
                                       fov + window + "\n"));
  };
  EXPECT_EQ(test::render(folder, {"-o", "both.exr", "--layers", "all", "--stereo", "0.5"}).code, 0);
  LayeredImage both = read_exr(folder / "both.exr");
  expect_view(both, views, 0, by_hand("-0.25", ""));
  expect_view(both, views, 1, by_hand("0.25", ""));
  EXPECT_EQ(both.metadata.at("caplet.stereo_separation"), "0.5");
  // At distance 4 the half window is 2 high: 0.25 is an eighth of it. Sides are 1.5 and 1.
  EXPECT_EQ(test::render(folder, {"-o", "both.exr", "--layers", "all", "--stereo", "0.5",
                                  "--convergence", "4"})
                .code,
            0);
  both = read_exr(folder / "both.exr");
  expect_view(both, views, 0, by_hand("-0.25", " \"float screenwindow\" [-1.375 1.625 -1 1]"));
  expect_view(both, views, 1, by_hand("0.25", " \"float screenwindow\" [-1.625 1.375 -1 1]"));
}

// The head stays where it is, and has one eye or the other.
TEST(Stereo, OfAHeadThatLooksAround) {
  const auto around = [](const std::string& eye) {
    return scene_from(
        "LookAt 0 0 -5 0 0 0 0 1 0\nScale 2 2 2\nCamera \"omnistereo\" \"float eye\" " + eye +
        "\n");
  };
  const auto folder = test::folder_with_scene(around("0"));
  const std::vector<std::string> views = {"left", "right"};
  EXPECT_EQ(test::render(folder, {"-o", "both.exr", "--layers", "all", "--stereo", "0.5"}).code, 0);
  const LayeredImage both = read_exr(folder / "both.exr");
  // A unit of the camera is half a unit of the world.
  expect_view(both, views, 0, rendered(folder, around("-0.5")));
  expect_view(both, views, 1, rendered(folder, around("0.5")));
}

// Both eyes go where the camera goes.
TEST(Stereo, OfACameraThatMoves) {
  const auto moving = [](const std::string& x) {
    return scene_from("ActiveTransform EndTime\nTranslate 0 1 0\nActiveTransform All\nLookAt " + x +
                      " 0 -5 " + x + " 0 0 0 1 0\nCamera \"perspective\"" + fov + "\n");
  };
  const auto folder = test::folder_with_scene(moving("0"));
  EXPECT_EQ(test::render(folder, {"-o", "both.exr", "--layers", "all", "--stereo", "0.5"}).code, 0);
  const LayeredImage both = read_exr(folder / "both.exr");
  expect_view(both, {"left", "right"}, 0, rendered(folder, moving("-0.25")));
  expect_view(both, {"left", "right"}, 1, rendered(folder, moving("0.25")));
}

TEST(Stereo, TheLibraryOpensBothViews) {
  const auto folder = test::folder_with_scene();
  EXPECT_EQ(test::render(folder, {"-o", "both.exr", "--stereo", "0.1"}).code, 0);
  const Imf::InputFile file((folder / "both.exr").c_str());
  ASSERT_TRUE(Imf::hasMultiView(file.header()));
  const Imf::StringVector views = Imf::multiView(file.header());
  EXPECT_THAT(views, ElementsAre("left", "right"));
  std::set<std::string> names;
  for (auto it = file.header().channels().begin(); it != file.header().channels().end(); ++it)
    names.insert(it.name());
  for (const char* name : {"R", "Z", "right.R", "right.Z", "albedo.left.R", "albedo.right.R",
                           "object.left.id", "object.right.id"})
    EXPECT_TRUE(names.contains(name)) << name;
  std::size_t left = 0, right = 0;
  for (const std::string& name : names)
    (Imf::viewFromChannelName(name, views) == "left" ? left : right)++;
  EXPECT_EQ(left, right);
  EXPECT_EQ(Imf::channelInOtherView("albedo.left.R", file.header().channels(), views, "right"),
            "albedo.right.R");
}

TEST(Stereo, OptionsThatAreWrongAreSaid) {
  const auto folder = test::folder_with_scene();
  for (const std::vector<std::string>& wrong : {std::vector<std::string>{"--stereo", "0"},
                                                {"--stereo", "-1"},
                                                {"--convergence", "3"},
                                                {"--stereo-layout", "sbs"},
                                                {"--stereo", "1", "--convergence", "0"},
                                                {"--stereo", "1", "--stereo-layout", "cross"},
                                                {"--display", "nowhere"}})
    EXPECT_EQ(test::render(folder, wrong).code, 2) << wrong[0] << wrong[1];
  EXPECT_THAT(test::names_in(folder), ElementsAre("scene.pbrt"));
}

#ifdef CAPLET_WITH_OIIO
TEST(Stereo, PreviewsShowBothViews) {
  const auto folder = test::folder_with_scene();
  const auto size_of = [&](const std::vector<std::string>& layout) {
    std::vector<std::string> arguments = {"-o", "none", "--preview", "p.png", "--stereo", "0.1"};
    arguments.insert(arguments.end(), layout.begin(), layout.end());
    EXPECT_EQ(test::render(folder, arguments).code, 0);
    const EnvironmentImage image = FileImageReader().read_rgb(folder / "p.png");
    return std::pair(image.width, image.height);
  };
  EXPECT_EQ(size_of({}), std::pair(48, 16));
  EXPECT_EQ(size_of({"--stereo-layout", "over-under"}), std::pair(24, 32));
  EXPECT_EQ(size_of({"--stereo-layout", "anaglyph"}), std::pair(24, 16));
}

TEST(Stereo, BothEyesHaveOneExposure) {
  const auto folder = test::folder_with_scene(
      test::small_scene +
      std::string("AreaLightSource \"diffuse\" \"rgb L\" [5 5 5] Translate -3 0 0 "
                  "Shape \"sphere\" \"float radius\" 0.8  # one eye sees it\n"));
  ASSERT_EQ(test::render(folder, {"-o", "p.exr", "--preview", "p.png", "--stereo", "3",
                                  "--stereo-layout", "over-under", "--exposure", "auto"})
                .code,
            0);
  const LayeredImage both = read_exr(folder / "p.exr");
  std::array<LayeredImage, 2> eyes;
  ExposureMeter meter;
  std::array<ExposureMeter, 2> own;
  for (const std::size_t eye : {0U, 1U}) {
    eyes[eye].width = eyes[eye].data_width = 24;
    eyes[eye].height = eyes[eye].data_height = 16;
    for (const char* name : {"R", "G", "B", "A"})
      eyes[eye].channels.push_back(*both.find((eye == 1 ? "right." : "") + std::string(name)));
    for (Channel& channel : eyes[eye].channels)
      if (eye == 1) channel.name = channel.name.substr(6);
    meter.add(eyes[eye]);
    own[eye].add(eyes[eye]);
  }
  EXPECT_NE(own[0].stops(), own[1].stops());
  std::vector<std::uint8_t> wanted;
  for (LayeredImage& eye : eyes) {
    eye.exposure.stops = meter.stops();
    const std::vector<std::uint8_t> bytes = preview_rgb8(eye);
    wanted.insert(wanted.end(), bytes.begin(), bytes.end());
  }
  EXPECT_EQ(FileImageReader().read_texture(folder / "p.png", {}).bytes, wanted);
}
#endif

TEST(Display, TevShowsThePictureOfTheFile) {
  const auto folder = test::folder_with_scene();
  test::TevServer server;
  const test::Result result = test::render(
      folder, {"-o", "out.exr", "--display", "127.0.0.1:" + server.port(), "--spp", "8"});
  EXPECT_EQ(result.code, 0) << result.err;
  server.stop();
  EXPECT_EQ(server.problem(), "");
  const auto pictures = server.pictures();
  ASSERT_EQ(pictures.count("out.exr"), 1u);
  const LayeredImage image = read_exr(folder / "out.exr");
  ASSERT_EQ(pictures.at("out.exr").channels.size(), image.channels.size());
  for (const Channel& channel : image.channels) {
    std::vector<float> values = channel.floats;
    for (const std::uint32_t id : channel.uints) values.push_back(static_cast<float>(id));
    EXPECT_EQ(pictures.at("out.exr").channels.at(channel.name), values) << channel.name;
  }
  // The same file as without it.
  EXPECT_EQ(test::render(folder, {"-o", "alone.exr", "--spp", "8"}).code, 0);
  const LayeredImage alone = read_exr(folder / "alone.exr");
  for (const Channel& channel : image.channels)
    EXPECT_EQ(channel.floats, alone.find(channel.name)->floats) << channel.name;
}

TEST(Display, WithoutTevThePictureIsMadeAllTheSame) {
  const auto folder = test::folder_with_scene();
  std::string port;
  {
    const test::TevServer gone;
    port = gone.port();
  }
  const test::Result result = test::render(folder, {"-o", "out.exr", "--display", port});
  EXPECT_EQ(result.code, 0);
  EXPECT_THAT(result.err, HasSubstr("tev at 127.0.0.1:" + port));
  EXPECT_EQ(read_exr(folder / "out.exr").width, 24);
}

}  // namespace
}  // namespace caplet
