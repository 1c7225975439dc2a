// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// `render --layers`: which channels a picture has, and that they are the ones of the whole picture.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "film/image.h"
#include "film/layers.h"
#include "program.h"
#include "support/data.h"

namespace caplet {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

TEST(Layers, AreThoseOfTheList) {
  const auto folder = test::folder_with_scene();
  const auto image_with = [&](std::vector<std::string> options) {
    options.insert(options.begin(), {"-o", "out.exr"});
    const test::Result result = test::render(folder, std::move(options));
    EXPECT_EQ(result.code, 0) << result.err;
    return read_exr(folder / "out.exr");
  };
  const auto names = [](const LayeredImage& image) {
    std::vector<std::string> out;
    for (const Channel& channel : image.channels) out.push_back(channel.name);
    std::ranges::sort(out);
    return out;
  };
  const LayeredImage all = image_with({"--layers", "all"});
  EXPECT_EQ(all.channels.size(), Layers::all().channels());
  EXPECT_EQ(names(image_with({"--variance"})), names(all));
  EXPECT_EQ(image_with({}).channels.size(), Layers::usual().channels());
  for (std::size_t i = 0; i < layer_rows.size(); ++i) {
    const std::string option = layer_rows[i].option;
    if (option.empty()) continue;
    EXPECT_EQ(image_with({"--layers", option}).channels.size(),
              Layers::none().with(static_cast<Layer>(i)).channels())
        << option;
  }
  EXPECT_EQ(names(image_with({"--layers", "all,Z"})), names(all));
  const LayeredImage alone = image_with({"--layers", "none"});
  EXPECT_THAT(names(alone), ElementsAre("A", "B", "G", "R"));
  EXPECT_EQ(alone.metadata.at("caplet.scene"), "scene.pbrt");
  EXPECT_THAT(names(image_with({"--layers", "none", "--variance"})),
              ElementsAre("A", "B", "G", "R", "variance.B", "variance.G", "variance.R"));
  const LayeredImage some = image_with({"--layers", "Z,N,primitive"});
  EXPECT_THAT(names(some),
              ElementsAre("A", "B", "G", "N.X", "N.Y", "N.Z", "R", "Z", "primitive.id"));
  for (const LayeredImage* image : {&alone, &some})
    for (const Channel& channel : image->channels) {
      const Channel* whole = all.find(channel.name);
      ASSERT_NE(whole, nullptr) << channel.name;
      EXPECT_EQ(channel.floats, whole->floats) << channel.name;
      EXPECT_EQ(channel.uints, whole->uints) << channel.name;
    }
}

TEST(Layers, PixelsBeyondAFloatAreSaidOnceForThePicture) {
  // Radiance 10^4 at an exposure of 10^36; enough rows for several bands.
  const auto folder = test::folder_with_scene(
      "LookAt 0 -5 1  0 0 0  0 0 1\nCamera \"perspective\"\nSampler \"zsobol\" \"integer "
      "pixelsamples\" 1\n"
      "Film \"rgb\" \"integer xresolution\" 2600 \"integer yresolution\" 1300 \"float iso\" "
      "1e38\nWorldBegin\n"
      "LightSource \"infinite\" \"rgb L\" [ 10000 10000 10000 ]\nShape \"sphere\" \"float radius\" "
      "0.01\n");
  const test::Result result = test::render(folder, {"-o", "out.exr", "--layers", "none"});
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_THAT(result.err, HasSubstr("3380000 of 3380000 pixels are beyond the range of a float and "
                                    "written black (the first: 0,0)"));
  EXPECT_EQ(std::ranges::count(result.err, '\n'), 1) << result.err;
}

TEST(Layers, UnknownOnesAreRefusedByTheNearestName) {
  const auto folder = test::folder_with_scene();
  for (const auto& [list, wrong, nearest] :
       {std::array<std::string, 3>{"albdo", "'albdo'", "'albedo'"},
        {"Z,objects", "'objects'", "'object'"},
        {"Z,", "''", "--layers"},
        {"none,Z", "'none'", "--layers"}}) {
    const test::Result result = test::render(folder, {"-o", "out.exr", "--layers", list});
    EXPECT_EQ(result.code, 2) << list;
    EXPECT_THAT(result.err, StartsWith("caplet: error: --layers: ")) << list;
    EXPECT_THAT(result.err, HasSubstr(wrong)) << list;
    EXPECT_THAT(result.err, HasSubstr(nearest)) << list;
    EXPECT_THAT(test::names_in(folder), ElementsAre("scene.pbrt")) << list;
  }
}

}  // namespace
}  // namespace caplet
