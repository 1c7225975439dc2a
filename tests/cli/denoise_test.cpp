// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Pictures without noise, by the library in place of Open Image Denoise that tests/support/oidn
// has.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "film/image.h"
#include "program.h"

namespace caplet {
namespace {

namespace fs = std::filesystem;
using test::folder_with_scene;
using test::Result;
using testing::AllOf;
using testing::HasSubstr;

using Names = std::vector<std::string>;

Result run(const fs::path& folder, const Names& arguments) {
  return test::run_program(arguments, folder, {{"CAPLET_OIDN", CAPLET_FAKE_OIDN}});
}

void expect_done(const Result& result) { ASSERT_EQ(result.code, 0) << result.err; }

const std::vector<float>& floats(const LayeredImage& image, const std::string& name) {
  const Channel* channel = image.find(name);
  if (!channel) throw std::out_of_range("there is no channel " + name);
  return channel->floats;
}

/// Expects R G B to be what the library in its place makes of the plain picture, over a backdrop of
/// one brightness, and noisy.R/G/B to be the plain picture over it.
void expect_denoised(const LayeredImage& image, const LayeredImage& plain, float backdrop,
                     const std::string& view = "") {
  constexpr std::array colors = {"R", "G", "B"}, normals = {"X", "Y", "Z"};
  for (const std::size_t c : {0U, 1U, 2U}) {
    const std::string color = colors.at(c);
    const auto &was = floats(plain, color), &coverage = floats(plain, "A"),
               &albedo = floats(plain, "albedo." + color),
               &normal = floats(plain, std::string("N.") + normals.at(c)),
               &now = floats(image, view + color), &noisy = floats(image, "noisy." + view + color);
    std::size_t lit = 0;
    for (std::size_t i = 0; i < was.size(); ++i) {
      const float behind = (1 - coverage[i]) * backdrop;
      EXPECT_NEAR(now[i], was[i] / 2 + albedo[i] / 2 + 3 * normal[i] / 8 + behind, 1e-6)
          << color << i;
      EXPECT_NEAR(noisy[i], was[i] + behind, 1e-6) << color << i;
      lit += now[i] != noisy[i] ? 1 : 0;
    }
    EXPECT_GT(lit, 20u);
  }
}

TEST(Denoised, PicturesKeepTheNoisyOne) {
  const fs::path folder = folder_with_scene();
  expect_done(run(folder, {"render", "scene.pbrt", "-o", "plain.exr"}));
  const LayeredImage plain = read_exr(folder / "plain.exr");
  EXPECT_EQ(plain.find("noisy.R"), nullptr);
  expect_done(run(folder, {"render", "scene.pbrt", "--denoise", "-o", "all.exr"}));
  const LayeredImage all = read_exr(folder / "all.exr");
  expect_denoised(all, plain, 0);
  EXPECT_EQ(all.channels.size(), plain.channels.size() + 3);
  EXPECT_EQ(all.metadata.at("caplet.denoiser"), "Open Image Denoise 2.9.7");
  // Guides that are not asked for are not written, whether there is a preview or not.
  for (const Names& more : {Names{}, Names{"--preview", "few.png"}}) {
    Names arguments{"render", "scene.pbrt", "--denoise", "-o", "few.exr", "--layers", "Z"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    expect_done(run(folder, arguments));
    const LayeredImage few = read_exr(folder / "few.exr");
    expect_denoised(few, plain, 0);
    EXPECT_EQ(few.channels.size(), 8u);
    EXPECT_EQ(floats(few, "Z"), floats(plain, "Z"));
  }
  // In bands of rows, too.
  expect_done(
      run(folder, {"render", "scene.pbrt", "-o", "plain.exr", "--size", "600x900", "--spp", "1"}));
  expect_done(run(folder, {"render", "scene.pbrt", "-o", "all.exr", "--size", "600x900", "--spp",
                           "1", "--denoise"}));
  expect_denoised(read_exr(folder / "all.exr"), read_exr(folder / "plain.exr"), 0);
}

TEST(Denoised, StatsTellItsTime) {
  const fs::path folder = folder_with_scene();
  const Result done =
      run(folder, {"render", "scene.pbrt", "-q", "--denoise", "-o", "all.exr", "--json"});
  expect_done(done);
  const auto seconds = nlohmann::json::parse(done.out).at("seconds");
  EXPECT_GT(seconds.at("denoise").get<double>(), 0);
  double sum = 0;
  for (const auto& [name, value] : seconds.items())
    if (name != "total") sum += value.get<double>();
  EXPECT_LE(sum, seconds.at("total").get<double>());
}

TEST(Denoised, ABackdropKeepsItsDetails) {
  const fs::path folder = folder_with_scene();
  expect_done(
      run(folder, {"render", "scene.pbrt", "--background", "transparent", "-o", "plain.exr"}));
  expect_done(run(folder, {"render", "scene.pbrt", "--background", "#ffffff", "--denoise", "-o",
                           "white.exr", "--preview", "white.png"}));
  expect_denoised(read_exr(folder / "white.exr"), read_exr(folder / "plain.exr"), 1);
}

TEST(Denoised, FilesMayAskForIt) {
  std::string scene = test::small_scene;
  scene.insert(scene.find("Film \"rgb\"") + 10, " \"bool denoise\" true ");
  const fs::path folder = folder_with_scene(scene), plain_folder = folder_with_scene();
  expect_done(run(folder, {"render", "scene.pbrt", "-o", "a.exr", "--film", "a.film"}));
  expect_done(run(plain_folder, {"render", "scene.pbrt", "-o", "a.exr", "--film", "a.film"}));
  const LayeredImage plain = read_exr(plain_folder / "a.exr");
  expect_denoised(read_exr(folder / "a.exr"), plain, 0);
  // Films know it, and merge can ask for it.
  expect_done(run(folder, {"merge", "a.film", "-o", "b.exr"}));
  expect_denoised(read_exr(folder / "b.exr"), plain, 0);
  expect_done(
      run(plain_folder, {"merge", "a.film", "-o", "b.exr", "--denoise", "--preview", "b.png"}));
  expect_denoised(read_exr(plain_folder / "b.exr"), plain, 0);
  EXPECT_EQ(read_exr(plain_folder / "b.exr").metadata.at("caplet.denoiser"),
            "Open Image Denoise 2.9.7");
  const Result missing = test::run_program({"render", "scene.pbrt", "-o", "c.exr"}, folder,
                                           {{"CAPLET_OIDN", "/nonexistent.so"}});
  EXPECT_EQ(missing.code, 1);
  EXPECT_THAT(missing.err, AllOf(HasSubstr("Film \"denoise\": "), HasSubstr("pip install pyoidn")));
  expect_done(run(folder, {"convert", "scene.pbrt", "again.pbrt"}));
  EXPECT_THAT(test::read_file(folder / "again.pbrt"), HasSubstr("\"bool denoise\" true"));
}

TEST(Denoised, EachEyeIs) {
  const fs::path folder = folder_with_scene();
  expect_done(
      run(folder, {"render", "scene.pbrt", "--stereo", "0.1", "--denoise", "-o", "two.exr"}));
  const LayeredImage two = read_exr(folder / "two.exr");
  EXPECT_NE(two.find("right.R"), nullptr);
  EXPECT_NE(two.find("noisy.right.R"), nullptr);
  EXPECT_NE(two.find("noisy.left.R"), nullptr);
  EXPECT_NE(floats(two, "right.R"), floats(two, "noisy.right.R"));
}

TEST(Denoised, IsRefusedBeforeRenderingWhereItCannotBe) {
  const fs::path folder = folder_with_scene();
  for (const Names& arguments : {Names{"render", "scene.pbrt", "--denoise", "-o", "a.exr"}}) {
    const Result result =
        test::run_program(arguments, folder, {{"CAPLET_OIDN", "/nonexistent.so"}});
    EXPECT_EQ(result.code, 1);
    EXPECT_THAT(result.err,
                AllOf(HasSubstr("error: --denoise: Open Image Denoise cannot be loaded"),
                      HasSubstr("/nonexistent.so"), HasSubstr("pip install pyoidn")));
    EXPECT_FALSE(fs::exists(folder / "a.exr"));
  }
  // A film alone is not denoised.
  expect_done(test::run_program({"render", "scene.pbrt", "--denoise", "--film", "a.film"}, folder,
                                {{"CAPLET_OIDN", CAPLET_FAKE_OIDN}, {"FAKE_OIDN_FAILS", "1"}}));
  // A failure while it works leaves what was there.
  test::write_file(folder / "a.exr", "before");
  const Result failed =
      test::run_program({"render", "scene.pbrt", "--denoise", "-o", "a.exr"}, folder,
                        {{"CAPLET_OIDN", CAPLET_FAKE_OIDN}, {"FAKE_OIDN_FAILS", "1"}});
  EXPECT_EQ(failed.code, 1);
  EXPECT_THAT(failed.err, HasSubstr("Open Image Denoise: as it was told to"));
  EXPECT_EQ(test::read_file(folder / "a.exr"), "before");
}

}  // namespace
}  // namespace caplet
