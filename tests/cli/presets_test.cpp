// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Presets against the options that they stand for.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "film/image.h"
#include "program.h"
#include "support/data.h"

namespace caplet {
namespace {

using Names = std::vector<std::string>;
using testing::AllOf;
using testing::HasSubstr;

constexpr const char* neuron = "1 1 0 0 0 2 -1\n2 3 0 9 0 1 1\n3 3 4 14 3 1 2\n4 2 -5 -6 2 1 1\n";

class Presets : public testing::Test {
 protected:
  Presets() : folder_(test::temporary_folder()) { test::write_file(folder_ / "cell.swc", neuron); }

  std::string picture(const Names& options, const char* file = "cell.swc") const {
    Names all{"render", file,     "-q",    "-o",    "none", "--preview",
              "p.png",  "--size", "60x40", "--spp", "2"};
    all.insert(all.end(), options.begin(), options.end());
    const test::Result result = test::run_program(all, folder_);
    EXPECT_EQ(result.code, 0) << result.err;
    return test::read_file(folder_ / "p.png");
  }

  std::filesystem::path folder_;
};

TEST_F(Presets, AreTheOptionsThatTheyStandFor) {
  EXPECT_EQ(picture({"--preset", "soft"}), picture({"--light", "flat", "--background", "white",
                                                    "--outline", "1.5", "--depth-cue", "0.4"}));
  EXPECT_EQ(picture({"--preset", "illustration"}),
            picture({"--light", "flat", "--background", "white", "--outline", "2.5"}));
  EXPECT_EQ(picture({"--preset", "paper"}), picture({"--background", "white", "--orthographic",
                                                     "--outline", "1", "--scale-bar", "auto"}));
  EXPECT_EQ(picture({"--preset", "dark"}),
            picture({"--light", "dramatic", "--background", "black"}));
}

TEST_F(Presets, YieldToWhatIsGiven) {
  EXPECT_EQ(picture({"--background", "#203040", "--preset", "soft", "--outline", "--light=studio"}),
            picture({"--background", "#203040", "--outline", "1.5", "--depth-cue", "0.4", "--light",
                     "studio"}));
  EXPECT_EQ(picture({"--preset", "paper", "--projection", "perspective"}),
            picture({"--background", "white", "--outline", "1", "--scale-bar", "auto"}));
  EXPECT_EQ(picture({"--preset", "paper", "--orthographic"}), picture({"--preset", "paper"}));
}

TEST_F(Presets, TakeAFilesOwnCamera) {
  test::write_file(folder_ / "own.pbrt", test::small_scene);
  // The capsule's middle is 5 units from the eye, where 40 degrees see 1.82 to each side.
  test::write_file(
      folder_ / "parallel.pbrt",
      "LookAt 0 0 5  0 0 0  0 1 0\nCamera \"orthographic\" \"float screenwindow\" "
      "[-2.7297767 2.7297767 -1.8198511 1.8198511]\n" +
          std::string(test::small_scene).substr(std::string(test::small_scene).find("Film")));
  // The window above is rounded, and so are depths, by which outlines run: a value may be the next
  // one.
  const auto bytes = [&](const char* file) {
    picture({"--preset", "paper"}, file);
    return FileImageReader().read_texture(folder_ / "p.png", {}).bytes;
  };
  const std::vector<std::uint8_t> own = bytes("own.pbrt"), parallel = bytes("parallel.pbrt");
  ASSERT_EQ(own.size(), parallel.size());
  for (std::size_t i = 0; i < own.size(); ++i) EXPECT_NEAR(own[i], parallel[i], 1) << i;
  EXPECT_NE(picture({"--preset", "paper", "--projection", "perspective"}, "own.pbrt"),
            picture({"--preset", "paper"}, "own.pbrt"));
}

TEST_F(Presets, NamesThatAreWrongAreTold) {
  const test::Result result =
      test::run_program({"render", "cell.swc", "-o", "p.png", "--preset", "papre"}, folder_);
  EXPECT_EQ(result.code, 2);
  EXPECT_THAT(result.err, AllOf(HasSubstr("--preset: 'papre' is none of: soft, illustration"),
                                HasSubstr("the nearest is 'paper'")));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "p.png"));
}

}  // namespace
}  // namespace caplet
