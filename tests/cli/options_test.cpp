// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Each option does what it says: what would be the same if it were passed over.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <random>

#include "film/film_file.h"
#include "film/image.h"
#include "program.h"
#include "support/data.h"
#include "support/sanitized.h"

namespace caplet {
namespace {

namespace fs = std::filesystem;
using test::Result;
using testing::HasSubstr;
using Names = std::vector<std::string>;

class Options : public testing::Test {
 protected:
  void SetUp() override { test::write_file(folder_ / "rays.txt", "0 0 5 0 0 -1\n"); }
  Result run(Names arguments, const std::map<std::string, std::string>& environment = {}) const {
    const Result result = test::run_program(arguments, folder_, environment);
    EXPECT_EQ(result.code, 0) << testing::PrintToString(arguments) << result.err;
    return result;
  }
  LayeredImage picture(Names more) const {
    more.insert(more.begin(), {"render", "scene.pbrt", "-q", "-o", "out.exr"});
    run(more);
    return read_exr(folder_ / "out.exr");
  }
  nlohmann::json json(const Names& arguments,
                      const std::map<std::string, std::string>& environment = {}) const {
    return nlohmann::json::parse(run(arguments, environment).out);
  }

  const fs::path folder_ = test::folder_with_scene();
};

TEST_F(Options, SeedMakesOtherSamples) {
  const LayeredImage one = picture({"--seed", "1"}), again = picture({"--seed", "1"}),
                     two = picture({"--seed", "2"});
  EXPECT_EQ(one.find("R")->floats, again.find("R")->floats);
  EXPECT_NE(one.find("R")->floats, two.find("R")->floats);
}

// What the help says of samples and sizes is what pictures of such files have.
TEST_F(Options, HelpSaysWhatPicturesUsuallyHave) {
  const std::string help = run({"render", "--help"}).out;
  std::string words;  // lines are broken anywhere between them
  for (const char c : help)
    if (c != '\n' && c != ' ') words += c;
  EXPECT_THAT(words, HasSubstr("saynothingofit5%"));
  EXPECT_THAT(words, HasSubstr("else1280x720"));
  EXPECT_THAT(words, HasSubstr("unlessasked0,1.5ofswc"));
  test::write_file(folder_ / "n.swc", "1 1 0 0 0 1 -1\n2 3 0 5 0 0.5 1\n");
  test::write_file(folder_ / "m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  test::write_file(folder_ / "s.pbrt", "WorldBegin\nShape \"sphere\"\n");
  for (const char* file : {"n.swc", "m.obj"}) {
    const nlohmann::json info = json({"info", file, "--json"});
    EXPECT_EQ(info.at("noise"), 0.05) << file;
    EXPECT_EQ(info.at("samples_per_pixel"), 16384) << file;
  }
  const nlohmann::json of_pbrt = json({"info", "s.pbrt", "--json"});
  EXPECT_FALSE(of_pbrt.contains("noise"));
  EXPECT_EQ(of_pbrt.at("samples_per_pixel"), 16);
  const nlohmann::json mesh = json({"info", "m.obj", "--json"});
  EXPECT_EQ(mesh.at("image").at("width"), 1280);
}

// Without scattering no light comes from a surface that does not emit; the sky is seen all the
// same.
TEST_F(Options, MaxDepthLimitsScattering) {
  const auto center = [](const LayeredImage& image) {
    return image.find("R")->floats[8 * 24 + 12];
  };
  const LayeredImage none = picture({"--max-depth", "0"});
  EXPECT_EQ(center(none), 0);
  EXPECT_GT(none.find("R")->floats[0], 0);
  EXPECT_GT(center(picture({"--max-depth", "1"})), 0);
}

// No sample is brighter than the limit, and so no pixel; the sky's luminance is above it.
TEST_F(Options, ClampLimitsSamples) {
  const auto brightest = [](const LayeredImage& image) {
    return *std::ranges::max_element(image.find("G")->floats);
  };
  const float free = brightest(picture({}));
  EXPECT_LE(brightest(picture({"--clamp", std::to_string(free / 100)})), 0.05f * free);
  EXPECT_EQ(brightest(picture({"--clamp", "0"})), free);
}

TEST_F(Options, BatchTakesLessMemory) {
  const auto peak = [&](const Names& more) {
    picture(more);
    return nlohmann::json::parse(test::read_file(folder_ / "stats.json"))
        .at("peak_device_bytes")
        .get<double>();
  };
  EXPECT_LT(peak({"--stats", "stats.json", "--batch", "64", "--size", "100x100"}),
            peak({"--stats", "stats.json", "--size", "100x100"}));
  // The film alone has 96 bytes a pixel fewer without layers (docs/output.md, "Films").
  EXPECT_LT(
      peak({"--stats", "stats.json", "--size", "100x100", "--layers", "none"}) + 96 * 100 * 100,
      peak({"--stats", "stats.json", "--size", "100x100"}));
}

/// Returns an MRtrix file of tracks of 100 points, which go straight on in any direction.
std::string straight_tracks(std::size_t count) {
  std::string out = "mrtrix tracks\ndatatype: Float32LE\nfile: . 100\nEND\n";
  out.resize(100);
  out.reserve(out.size() + 12 * (101 * count + 1));
  const auto put = [&out](const std::array<float, 3>& point) {
    out.append(reinterpret_cast<const char*>(point.data()), sizeof point);
  };
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  std::minstd_rand random(1);
  std::uniform_real_distribution<float> place(-100, 100), way(-0.5F, 0.5F);
  for (std::size_t i = 0; i < count; ++i) {
    std::array<float, 3> at{place(random), place(random), place(random)};
    const std::array<float, 3> step{way(random), way(random), way(random)};
    for (int k = 0; k < 100; ++k) {
      put(at);
      for (std::size_t axis = 0; axis < 3; ++axis) at.at(axis) += step.at(axis);
    }
    put({nan, nan, nan});
  }
  constexpr float infinity = std::numeric_limits<float>::infinity();
  put({infinity, infinity, infinity});
  return out;
}

// A hundred million of them are to fit into 6 GB (docs/performance.md). What the program takes
// without any is not counted.
TEST_F(Options, CapsulesInARowTakeAtMost62Bytes) {
  if (test::sanitized) GTEST_SKIP() << "sanitizers take more memory";
  const auto peak = [&](std::size_t tracks) {
    test::write_file(folder_ / "tracks.tck", straight_tracks(tracks));
    return json({"render", "tracks.tck", "-q", "-o", "out.exr", "--size", "16x16", "--spp", "1",
                 "--layers", "none", "--stats", "-"})
        .at("peak_bytes")
        .get<double>();
  };
  peak(1);  // compiles, which may take more
  const double few = peak(20000), many = peak(40000);
  EXPECT_LT(few, many);
  EXPECT_LT((many - few) / (99 * 20000), 62);
}

TEST_F(Options, VarianceIsWrittenWhenAsked) {
  EXPECT_EQ(picture({}).find("variance.R"), nullptr);
  EXPECT_NE(picture({"--variance"}).find("variance.R"), nullptr);
}

// PoCL shows one device for each name in POCL_DEVICES.
TEST_F(Options, DeviceIsTheOneThatIsNamed) {
  const std::map<std::string, std::string> two = {{"POCL_DEVICES", "basic pthread"}};
  const auto devices = json({"devices", "--json"}, two);
  if (devices.size() != 2) GTEST_SKIP() << "needs PoCL, with its devices 'basic' and 'pthread'";
  for (const char* index : {"0", "1"}) {
    const std::string name = devices[static_cast<std::size_t>(index[0] - '0')].at("name");
    run({"render", "scene.pbrt", "-q", "-o", "out.exr", "--spp", "1", "--device", index}, two);
    EXPECT_EQ(read_exr(folder_ / "out.exr").metadata.at("caplet.device"), name);
    run({"render", "scene.pbrt", "-q", "-o", "out.exr", "--spp", "1", "--device", name}, two);
    EXPECT_EQ(read_exr(folder_ / "out.exr").metadata.at("caplet.device"), name);
    EXPECT_EQ(json({"pick", "scene.pbrt", "--pixel", "12,8", "--json", "--device", index}, two)
                  .at("device"),
              name);
    const auto verified =
        json({"verify", "scene.pbrt", "--rays", "100", "--json", "--device", index}, two);
    EXPECT_EQ(verified.at("devices")[0].at("name"), name);
  }
}

TEST_F(Options, TheHeatmapsSize) {
  run({"verify", "scene.pbrt", "-q", "--rays", "10", "--heatmap", "heat.exr", "--size", "30x20"});
  EXPECT_EQ(read_exr(folder_ / "heat.exr").data_width, 30);
  EXPECT_EQ(read_exr(folder_ / "heat.exr").data_height, 20);
}

TEST_F(Options, SeedOfVerifyMakesOtherRays) {
  const auto kinds = [&](const char* seed) {
    return json({"verify", "scene.pbrt", "--rays", "2000", "--seed", seed, "--json"}).at("kinds");
  };
  EXPECT_EQ(kinds("1"), kinds("1"));
  EXPECT_NE(kinds("1"), kinds("2"));
}

TEST_F(Options, QuietCommandsSayNothing) {
  for (const Names& arguments :
       {Names{"verify", "scene.pbrt", "--rays", "100"},
        Names{"pick", "scene.pbrt", "--rays", "rays.txt", "--out", "out.csv"},
        Names{"render", "scene.pbrt", "-o", "out.exr"}}) {
    Names quiet = arguments;
    quiet.push_back("--quiet");
    EXPECT_EQ(run(quiet).err, "") << arguments[0];
    EXPECT_NE(run(arguments).err, "") << arguments[0];
  }
}

TEST_F(Options, PickedPixelsAreOfTheCrop) {
  EXPECT_EQ(
      json({"pick", "scene.pbrt", "--pixel", "12,8", "--json", "--crop", "12,8,13,9"}).at("hit"),
      true);
  const Result outside =
      test::run_program({"pick", "scene.pbrt", "--pixel", "12,9", "--crop", "12,8,13,9"}, folder_);
  EXPECT_EQ(outside.code, 2);
  EXPECT_THAT(outside.err, HasSubstr("--pixel: 12,9 is outside of the crop"));
}

TEST_F(Options, StatsTellHowLongWritingTook) {
  picture({"--stats", "stats.json"});
  const auto seconds = nlohmann::json::parse(test::read_file(folder_ / "stats.json")).at("seconds");
  EXPECT_GT(seconds.at("write").get<double>(), 0);
  EXPECT_LE(seconds.at("write").get<double>() + seconds.at("render").get<double>(),
            seconds.at("total").get<double>());
}

TEST_F(Options, JsonIsTheStatsOnStdout) {
  const test::Result told = test::run_program(
      {"render", "scene.pbrt", "-q", "--spp", "2", "-o", "out.exr", "--json"}, folder_);
  EXPECT_EQ(told.code, 0) << told.err;
  const auto stats = nlohmann::json::parse(told.out);
  EXPECT_EQ(stats.at("samples_per_pixel"), 2);
  EXPECT_EQ(stats.at("seconds").count("denoise"), 0u);
  const test::Result both = test::run_program(
      {"render", "scene.pbrt", "-o", "out.exr", "--json", "--stats", "a.json"}, folder_);
  EXPECT_EQ(both.code, 2);
  EXPECT_THAT(both.err, HasSubstr("--stats"));
}

// The noise is that of G, also where the picture is written twice.
TEST_F(Options, StatsStateTheNoise) {
  picture({"--stats", "stats.json"});
  EXPECT_FALSE(nlohmann::json::parse(test::read_file(folder_ / "stats.json")).contains("noise"));
  picture({"--stats", "stats.json", "--variance", "-o", "two.exr", "--preview", "out.png", "--film",
           "out.film"});
  const Film film = load_film(folder_ / "out.film").film;
  const int width = film.layout().window.width, height = film.layout().window.height;
  // Each pixel's mean luminance, and its variance by the pixel's two replicates.
  std::vector<double> luminances, variances;
  std::vector<bool> seen;
  for (std::size_t i = 0; i < film.layout().window.pixels(); ++i) {
    const double n = film.samples(i), n1 = film.first_replicate_samples(i),
                 all = film.sum(Layer::color, 1, i), first = film.sum(Layer::variance, 1, i),
                 difference = first / n1 - (all - first) / (n - n1);
    luminances.push_back(all / n);
    variances.push_back(difference * difference * n1 * (n - n1) / (n * n));
    // Light of a backdrop that varies counts too, beyond what is rounded away.
    seen.push_back(film.sum(Layer::coverage, 0, i) > 0 ||
                   std::abs(difference) > 1e-12 * luminances.back());
  }
  // Over the mean luminance at most 3 pixels away and a quarter of the picture's (docs/output.md).
  double sum = 0, pixels = 0, variance = 0;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    sum += seen[i] ? luminances[i] : 0;
    pixels += seen[i] ? 1 : 0;
  }
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const auto at = [&](int row, int column) {
        return static_cast<std::size_t>(row * width + column);
      };
      if (!seen[at(y, x)]) continue;
      double around = 0, others = 0;
      for (int i = std::max(0, y - 3); i <= std::min(height - 1, y + 3); ++i)
        for (int j = std::max(0, x - 3); j <= std::min(width - 1, x + 3); ++j)
          if (seen[at(i, j)]) {
            around += luminances[at(i, j)];
            ++others;
          }
      variance += variances[at(y, x)] / std::pow(around / others + 0.25 * sum / pixels, 2);
    }
  ASSERT_GT(variance, 0);
  const double noise =
      nlohmann::json::parse(test::read_file(folder_ / "stats.json")).at("noise").get<double>();
  // Luminances and variances are kept as floats: each term is off by 2^-22 at most.
  EXPECT_NEAR(noise, std::sqrt(variance / pixels), 1e-6 * noise);
}

}  // namespace
}  // namespace caplet
