// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// `caplet render --noise`, and films whose pixels have different numbers of samples.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "film/film_file.h"
#include "film/image.h"
#include "pictures.h"
#include "program.h"

namespace caplet::noise_test {
namespace {

namespace fs = std::filesystem;

using test::folder_with_scene;
using test::render;
using test::Result;
using testing::HasSubstr;
using testing::Not;

using Names = std::vector<std::string>;

/// A capsule on a floor under a lamp, before a sky without light.
const std::string lit =
    "LookAt 0 -5 2  0 0 0.5  0 0 1\nCamera \"perspective\" \"float fov\" 40\n"
    "Film \"rgb\" \"integer xresolution\" 24 \"integer yresolution\" 16\nWorldBegin\n"
    "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [30 30 30]\n"
    "Translate 1 -2 4 Shape \"sphere\" \"float radius\" 0.3 AttributeEnd\n"
    "Shape \"disk\" \"float radius\" 1.5\n"
    "Shape \"capsule\" \"point3 p0\" [-.5 0 .4] \"point3 p1\" [.5 0 .4] \"float radius\" 0.4\n";

void expect_done(const Result& result) { ASSERT_EQ(result.code, 0) << result.err; }

nlohmann::json json_of(const fs::path& file) {
  return nlohmann::json::parse(test::read_file(file));
}

const std::vector<std::uint32_t>& samples_of(const LayeredImage& image) {
  const Channel* channel = image.find("samples");
  if (!channel) throw std::out_of_range("no channel of samples");
  return channel->uints;
}

double mean_of(const std::vector<std::uint32_t>& samples) {
  double sum = 0;
  for (const std::uint32_t n : samples) sum += n;
  return sum / static_cast<double>(samples.size());
}

// On a display, two stops are a lamp four times as bright.
TEST(Noise, OnADisplayIsThatOfItsExposure) {
  const auto samples = [](const std::string& text, const Names& more) {
    const fs::path folder = folder_with_scene(text);
    Names all{"--noise", "0.4%", "--noise-space", "display", "-o", "a.exr"};
    all.insert(all.end(), more.begin(), more.end());
    expect_done(render(folder, all));
    return samples_of(read_exr(folder / "a.exr"));
  };
  std::string bright = lit;
  bright.replace(bright.find("30 30 30"), 8, "120 120 120");
  const auto exposed = samples(lit, {"--exposure", "2"});
  EXPECT_EQ(exposed, samples(bright, {}));
  EXPECT_NE(exposed, samples(lit, {}));
  EXPECT_EQ(samples(lit, {"--exposure", "auto"}), samples(lit, {}));
}

// A file may ask for a noise; a number of samples, or another noise, is taken in its place.
TEST(Noise, MayStandInTheFile) {
  const fs::path folder = folder_with_scene(
      "Sampler \"sobol\" \"float noise\" 0.04 \"integer pixelsamples\" 200\n" + lit);
  const auto told = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"render", "scene.pbrt"});
    return test::run_program(more, folder);
  };
  const Result result = told({"-o", "file.exr"});
  expect_done(result);
  EXPECT_THAT(result.err, HasSubstr("noise 4 % on "));
  expect_done(render(folder, {"-o", "flag.exr", "--noise", "4%", "--spp", "200"}));
  const LayeredImage by_file = read_exr(folder / "file.exr"),
                     by_flag = read_exr(folder / "flag.exr");
  EXPECT_EQ(samples_of(by_file), samples_of(by_flag));
  EXPECT_EQ(by_file.find("G")->floats, by_flag.find("G")->floats);
  EXPECT_GT(mean_of(samples_of(by_file)), 16.5);
  const Result other = told({"-o", "other.exr", "--noise", "30%"});
  expect_done(other);
  EXPECT_THAT(other.err, HasSubstr("noise 30 % on "));
  const Result even = told({"-o", "even.exr", "--spp", "3"});
  expect_done(even);
  EXPECT_THAT(even.err, HasSubstr("3 samples per pixel on "));
  EXPECT_FALSE(read_exr(folder / "even.exr").find("samples"));
}

TEST(Noise, IsThatOfThePicture) {
  const fs::path folder = folder_with_scene(lit);
  const Result result = test::run_program(
      {"render", "scene.pbrt", "--noise", "4%", "-o", "a.exr", "--stats", "a.json"}, folder);
  expect_done(result);
  EXPECT_THAT(result.err, HasSubstr("noise 4 % on "));
  EXPECT_THAT(result.err,
              testing::ContainsRegex("noise 3\\.[0-9]+ % after [0-9.]+ samples per pixel"));
  const LayeredImage image = read_exr(folder / "a.exr");
  const std::vector<std::uint32_t>& samples = samples_of(image);
  EXPECT_EQ(*std::ranges::min_element(samples), 16u);
  EXPECT_GT(*std::ranges::max_element(samples), 64u);
  EXPECT_TRUE(image.find("variance.G"));
  // By the variances that it states, which know 49 pixels each: of 200 pixels, to a tenth or so.
  EXPECT_NEAR(json_of(folder / "a.json").at("noise").get<double>(), 0.04, 0.008);
  EXPECT_NEAR(mean_of(samples), json_of(folder / "a.json").at("samples_per_pixel").get<double>(),
              0.5);
  EXPECT_EQ(image.metadata.at("caplet.samples_per_pixel"),
            std::to_string(json_of(folder / "a.json").at("samples_per_pixel").get<int>()));
  // Half the noise takes up to four times the samples, but for pixels that have the least.
  expect_done(render(folder, {"--noise", "0.02", "-o", "b.exr"}));
  const double more = mean_of(samples_of(read_exr(folder / "b.exr"))) / mean_of(samples);
  EXPECT_GT(more, 1.8);
  EXPECT_LT(more, 5);
}

TEST(Noise, StaysWithinTheSamplesThatAreAskedFor) {
  const fs::path folder = folder_with_scene(lit);
  const Result result = test::run_program({"render", "scene.pbrt", "--noise", "0.5%", "--spp", "96",
                                           "--min-spp", "24", "-o", "a.exr", "--layers", "none"},
                                          folder);
  expect_done(result);
  EXPECT_THAT(result.err, HasSubstr("; 0.5 % are asked for, with up to 96 (--spp)"));
  const LayeredImage image = read_exr(folder / "a.exr");
  EXPECT_EQ(*std::ranges::min_element(samples_of(image)), 24u);
  EXPECT_EQ(*std::ranges::max_element(samples_of(image)), 96u);
  EXPECT_FALSE(image.find("variance.G"));
  // Where all pixels have as many, there is no channel of them.
  expect_done(render(folder, {"--noise", "100%", "-o", "b.exr"}));
  EXPECT_FALSE(read_exr(folder / "b.exr").find("samples"));
  EXPECT_EQ(read_exr(folder / "b.exr").metadata.at("caplet.samples_per_pixel"), "16");
}

TEST(Noise, WhatIsNoNoiseIsRefused) {
  const fs::path folder = folder_with_scene(lit);
  const auto refused = [&](const Names& arguments, const char* why) {
    const Result result = render(folder, arguments);
    EXPECT_EQ(result.code, 2) << why;
    EXPECT_THAT(result.err, HasSubstr(why));
  };
  for (const char* text : {"0", "-1%", "101%", "2", "x", "", "%", "5 %", "nan", "0.0001%", "5%%"})
    refused({"--noise", text}, "from 0.001% to 100%, such as 5%");
  refused({"--min-spp", "8"}, "--min-spp: goes with --noise or --time");
  refused({"--noise-space", "display"}, "--noise-space: goes with --noise");
  refused({"--noise", "5%", "--noise-space", "screen"}, "--noise-space");
  refused({"--noise", "5%", "--min-spp", "8", "--spp", "7"},
          "--min-spp: 8 is more than the most, 7");
  refused({"--noise", "5%", "--min-spp", "1"}, "--min-spp");
  refused({"--noise", "5%", "--samples", "0:8"}, "--samples: does not go with --noise");
  EXPECT_THAT(test::names_in(folder), testing::ElementsAre("scene.pbrt"));
}

// zsobol's points are even at one number of samples alone.
TEST(Noise, ClosedSamplersAreReplaced) {
  for (const char* sampler : {"zsobol", "stratified"}) {
    const fs::path folder = folder_with_scene("Sampler \"" + std::string(sampler) + "\"\n" + lit);
    const Result result = render(folder, {"--noise", "10%", "-o", "a.exr"});
    expect_done(result);
    EXPECT_THAT(result.err,
                HasSubstr("--noise: the sampler is sobol in place of " + std::string(sampler)));
    test::write_file(folder / "scene.pbrt", "Sampler \"sobol\"\n" + lit);
    const Result other = render(folder, {"--noise", "10%", "-o", "b.exr"});
    EXPECT_THAT(other.err, Not(HasSubstr("sampler")));
    test::expect_equal_pictures(folder / "a.exr", folder / "b.exr");
  }
}

// A render that its time stopped goes on to the bits of one render; and to a number of samples of
// all pixels.
TEST(Noise, FilmsGoOn) {
  const fs::path folder = folder_with_scene(lit);
  expect_done(render(folder, {"--noise", "3%", "-o", "one.exr", "--film", "one.film"}));
  expect_done(render(folder, {"--noise", "3%", "--time", "1e-6", "--film", "two.film"}));
  EXPECT_LE(load_film(folder / "two.film").film.mean_samples(), 16);
  expect_done(render(folder, {"--noise", "3%", "--film", "two.film", "--resume", "-o", "two.exr"}));
  test::expect_equal_pictures(folder / "one.exr", folder / "two.exr");
  const SavedFilm one = load_film(folder / "one.film"), two = load_film(folder / "two.film");
  EXPECT_TRUE(std::ranges::equal(one.film.words(), two.film.words()));
  EXPECT_EQ(one.film.parts(), two.film.parts());
  EXPECT_EQ(one.samples_wanted, 0u);

  const Result told = test::run_program({"film", "one.film"}, folder);
  EXPECT_THAT(told.out,
              testing::ContainsRegex("samples +0:[0-9]+, of a pixel [0-9.]+ in the mean\n"));
  const auto json =
      nlohmann::json::parse(test::run_program({"film", "one.film", "--json"}, folder).out);
  EXPECT_NEAR(json.at("mean_samples").get<double>(), one.film.mean_samples(), 1e-9);

  const std::uint32_t most = one.film.parts().front().sample_count;
  const std::string all = std::to_string(most + 7);
  expect_done(render(
      folder, {"--spp", all, "--variance", "--film", "two.film", "--resume", "-o", "two.exr"}));
  expect_done(render(folder, {"--spp", all, "--variance", "-o", "even.exr"}));
  test::expect_equal_pictures(folder / "two.exr", folder / "even.exr");
}

// Files of formats that say nothing of samples are rendered to 5 %; pbrt's have 16 samples.
TEST(Noise, IsTheDefaultOfFilesWithoutSamples) {
  const fs::path folder = folder_with_scene(lit);
  test::write_file(folder / "a.swc", "1 1 0 0 0 4 -1\n2 3 0 20 0 1 1\n3 3 8 30 0 1 2\n");
  const auto told = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"render", "a.swc", "--size", "24x16"});
    const Result result = test::run_program(more, folder);
    expect_done(result);
    return result.err;
  };
  EXPECT_THAT(told({"-o", "a.exr"}), HasSubstr("noise 5 % on "));
  EXPECT_TRUE(read_exr(folder / "a.exr").find("variance.G"));
  told({"-o", "b.exr", "--noise", "5%"});
  test::expect_equal_pictures(folder / "a.exr", folder / "b.exr");
  EXPECT_THAT(told({"-o", "c.exr", "--spp", "5"}), HasSubstr("5 samples per pixel on "));
  EXPECT_THAT(test::run_program({"render", "scene.pbrt", "-o", "d.exr"}, folder).err,
              HasSubstr("16 samples per pixel on "));
  const Result share =
      test::run_program({"render", "a.swc", "--samples", "1/4", "--film", "a.film"}, folder);
  EXPECT_EQ(share.code, 2);
  EXPECT_THAT(share.err, HasSubstr("--samples: needs --spp: the scene is rendered to a noise"));
  told({"--samples", "1/4", "--spp", "8", "--film", "a.film"});
  EXPECT_EQ(load_film(folder / "a.film").film.mean_samples(), 2);
}

// A display's range is another measure: of this picture, whose noise lies in dark places, it takes
// other samples. The noise that is stated is in the same measure.
TEST(Noise, MayBeAShareOfADisplay) {
  const fs::path folder = folder_with_scene(lit);
  expect_done(render(
      folder, {"--noise", "0.4%", "--noise-space", "display", "-o", "a.exr", "--stats", "a.json"}));
  expect_done(render(folder, {"--noise", "2%", "-o", "b.exr"}));
  EXPECT_NEAR(json_of(folder / "a.json").at("noise").get<double>(), 0.004, 0.0008);
  EXPECT_NE(samples_of(read_exr(folder / "a.exr")), samples_of(read_exr(folder / "b.exr")));
  test::write_file(
      folder / "scene.pbrt",
      "Sampler \"sobol\" \"float noise\" 0.004 \"string noisespace\" \"display\"\n" + lit);
  expect_done(render(folder, {"-o", "c.exr"}));
  test::expect_equal_pictures(folder / "a.exr", folder / "c.exr");
}

// A time that is over at once still leaves the samples that are asked for at least.
TEST(Noise, TimesEndAfterTheLeastSamples) {
  const fs::path folder = folder_with_scene(lit);
  expect_done(render(folder, {"--time", "1e-6", "--min-spp", "6", "--spp", "4096", "-o", "a.exr",
                              "--stats", "a.json"}));
  EXPECT_EQ(json_of(folder / "a.json").at("samples_per_pixel"), 6);
  expect_done(render(folder, {"--spp", "6", "-o", "b.exr"}));
  const LayeredImage a = read_exr(folder / "a.exr"), b = read_exr(folder / "b.exr");
  EXPECT_EQ(a.find("G")->floats, b.find("G")->floats);
  expect_done(
      render(folder, {"--time", "1e-6", "--min-spp", "24", "--noise", "0.1%", "--film", "c.film"}));
  EXPECT_EQ(load_film(folder / "c.film").film.mean_samples(), 24);
  expect_done(render(folder, {"--time", "1e-6", "--min-spp", "99", "--spp", "3", "-o", "d.exr",
                              "--stats", "d.json"}));
  EXPECT_EQ(json_of(folder / "d.json").at("samples_per_pixel"), 3) << "no more than the most";
}

// Frames and both eyes are each rendered to it.
TEST(Noise, IsThatOfEachFrame) {
  const fs::path folder = folder_with_scene(lit);
  expect_done(render(folder, {"--noise", "3%", "--turntable", "2", "-o", "a.#.exr"}));
  for (const char* name : {"a.1.exr", "a.2.exr"})
    EXPECT_GT(mean_of(samples_of(read_exr(folder / name))), 16);
  expect_done(render(folder, {"--noise", "3%", "--stereo", "0.1", "-o", "both.exr"}));
}

}  // namespace
}  // namespace caplet::noise_test
