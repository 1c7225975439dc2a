// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Films of `render`: shares of samples, checkpoints, going on after a stop, and `merge`.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <nlohmann/json.hpp>
#include <random>
#include <thread>

#include "film/film_file.h"
#include "film/image.h"
#include "pictures.h"
#include "program.h"
#include "small_disk.h"

namespace caplet::film_test {
namespace {

namespace fs = std::filesystem;
using test::folder_with_scene;
using test::render;
using test::Result;
using test::run_program;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

using Names = std::vector<std::string>;

constexpr int stopped = 75;
constexpr const char* endless = "16000000";  // samples

void expect_done(const Result& result) { ASSERT_EQ(result.code, 0) << result.err; }

Result merge(const fs::path& folder, Names arguments) {
  arguments.insert(arguments.begin(), "merge");
  return run_program(arguments, folder);
}

std::vector<SampleSpan> samples_in(const fs::path& film) {
  return samples_of(load_film(film).film);
}

TEST(Films, SharesMergeInAnyOrderToOneRender) {
  const fs::path folder = folder_with_scene();
  expect_done(render(folder, {"--spp", "10", "--variance", "-o", "whole.exr"}));
  for (const char* share : {"1", "2", "3"})
    expect_done(render(folder, {"--spp", "10", "--variance", "--samples", std::string(share) + "/3",
                                "--film", std::string(share) + ".film"}));
  // Of a share nothing but its film is written.
  EXPECT_THAT(test::names_in(folder),
              ElementsAre("1.film", "2.film", "3.film", "scene.pbrt", "whole.exr"));
  EXPECT_THAT(samples_in(folder / "2.film"), ElementsAre(SampleSpan{3, 6}));
  expect_done(merge(folder, {"2.film", "3.film", "1.film", "-o", "sum.exr", "-o", "sum.png"}));
  test::expect_equal_pictures(folder / "sum.exr", folder / "whole.exr");
  EXPECT_EQ(read_exr(folder / "sum.exr").metadata.at("caplet.samples_per_pixel"), "10");
  EXPECT_TRUE(fs::exists(folder / "sum.png"));
  // A sum is a film, which goes with others.
  expect_done(merge(folder, {"3.film", "1.film", "--film", "13.film"}));
  const Result rest = merge(folder, {"13.film", "2.film", "-o", "again.exr", "--film", "all.film"});
  expect_done(rest);
  EXPECT_THAT(rest.err, Not(HasSubstr("missing")));
  test::expect_equal_pictures(folder / "again.exr", folder / "whole.exr");
  expect_done(render(folder, {"--spp", "10", "--variance", "--film", "one.film"}));
  const SavedFilm one = load_film(folder / "one.film"), all = load_film(folder / "all.film");
  EXPECT_TRUE(std::ranges::equal(one.film.words(), all.film.words()));
  EXPECT_EQ(one.film.parts(), all.film.parts());
  EXPECT_EQ(one.scene, all.scene);
  EXPECT_EQ(one.view, all.view);
  EXPECT_EQ(one.notes.at("caplet.device"), all.notes.at("caplet.device"));
}

TEST(Films, RangesOfSamplesAreThoseAskedFor) {
  const fs::path folder = folder_with_scene();
  expect_done(render(folder, {"--samples", "3:7", "--film", "a.film"}));
  EXPECT_THAT(samples_in(folder / "a.film"), ElementsAre(SampleSpan{3, 7}));
  // Without a film a picture of them is written.
  expect_done(render(folder, {"--samples", "3:7", "-o", "picture.exr"}));
  EXPECT_EQ(read_exr(folder / "picture.exr").metadata.at("caplet.samples_per_pixel"), "4");
  expect_done(merge(folder, {"a.film", "-o", "a.exr"}));
  test::expect_equal_pictures(folder / "a.exr", folder / "picture.exr");
  for (const auto& [text, why] :
       std::vector<std::pair<const char*, const char*>>{{"3", "is not A:B or I/N"},
                                                        {"3:3", "is not A:B with A < B"},
                                                        {"4:3", "is not A:B with A < B"},
                                                        {"0:99999999", "up to 16777216"},
                                                        {"-1:3", "is not A:B or I/N"},
                                                        {"1:3x", "is not A:B or I/N"},
                                                        {"0/4", "is not I/N with I from 1 to N"},
                                                        {"5/4", "is not I/N with I from 1 to N"},
                                                        {"1/3", "has no sample: there are 2"}}) {
    const Result result = render(folder, {"--samples", text, "--film", "b.film"});
    EXPECT_EQ(result.code, 2) << text;
    EXPECT_THAT(result.err, AllOf(HasSubstr("--samples"), HasSubstr(why))) << text;
  }
  EXPECT_FALSE(fs::exists(folder / "b.film"));
}

TEST(Films, ResumeGoesOnToTheBitsOfOneRender) {
  const fs::path folder = folder_with_scene();
  expect_done(render(folder, {"--spp", "9", "-o", "whole.exr"}));
  // The first time there is no film yet.
  const Names command{"-o", "out.exr", "--resume"};
  Names first = command, second = command;
  first.insert(first.end(), {"--spp", "4"});
  second.insert(second.end(), {"--spp", "9"});
  expect_done(render(folder, first));
  EXPECT_THAT(samples_in(folder / "out.film"), ElementsAre(SampleSpan{0, 4}));
  const auto seconds = [&] {
    return std::stod(read_exr(folder / "out.exr").metadata.at("caplet.render_seconds"));
  };
  const double before = seconds();
  expect_done(render(folder, second));
  test::expect_equal_pictures(folder / "out.exr", folder / "whole.exr");
  const double after = seconds();
  EXPECT_GT(after, before);
  EXPECT_EQ(read_exr(folder / "out.exr").metadata.at("caplet.samples_per_pixel"), "9");
  // What is complete stays so.
  expect_done(render(folder, second));
  test::expect_equal_pictures(folder / "out.exr", folder / "whole.exr");
  EXPECT_GE(seconds(), after);
  expect_done(render(folder, first));
  test::expect_equal_pictures(folder / "out.exr", folder / "whole.exr");
  // A share goes on within itself.
  expect_done(render(folder, {"--samples", "4:6", "--film", "share.film"}));
  expect_done(render(folder, {"--samples", "4:9", "--film", "share.film", "--resume"}));
  EXPECT_THAT(samples_in(folder / "share.film"), ElementsAre(SampleSpan{4, 9}));
  expect_done(render(folder, {"--spp", "4", "--film", "begin.film"}));
  expect_done(merge(folder, {"share.film", "begin.film", "-o", "sum.exr"}));
  test::expect_equal_pictures(folder / "sum.exr", folder / "whole.exr");
}

TEST(Films, OtherPicturesAreRefused) {
  const fs::path folder = folder_with_scene();
  const std::string scene = test::small_scene;
  test::write_file(folder / "thick.pbrt", scene + "Shape \"sphere\" \"float radius\" 0.1\n");
  expect_done(render(folder, {"--film", "a.film"}));
  const std::string before = test::read_file(folder / "a.film");
  const auto refused = [&](Names other, const char* why, const char* of_merge) {
    other.insert(other.end(), {"--film", "a.film", "--resume", "-q"});
    other.insert(other.begin(), "render");
    const Result result = run_program(other, folder);
    EXPECT_EQ(result.code, 2) << why;
    EXPECT_THAT(result.err,
                AllOf(HasSubstr("a.film: this film cannot be continued"), HasSubstr(why)));
    EXPECT_EQ(test::read_file(folder / "a.film"), before) << why;
    for (const char* option : {"--resume", "--film", "a.film"}) std::erase(other, option);
    other.insert(other.end(), {"--film", "b.film", "--samples", "2:4"});
    expect_done(run_program(other, folder));
    const Result sum = merge(folder, {"a.film", "b.film", "-o", "sum.exr"});
    EXPECT_EQ(sum.code, 2) << why;
    EXPECT_THAT(sum.err, AllOf(HasSubstr("b.film: does not go with a.film"), HasSubstr(of_merge)));
    EXPECT_FALSE(fs::exists(folder / "sum.exr"));
  };
  refused({"scene.pbrt", "--size", "30x16"}, "its size is 24 x 16, not 30 x 16",
          "its size is 30 x 16, not 24 x 16");
  refused({"scene.pbrt", "--crop", "0,0,8,9"}, "its crop is 0,0,24,16, not 0,0,8,9",
          "its crop is 0,0,8,9, not 0,0,24,16");
  refused({"scene.pbrt", "--layers", "Z"}, "its layers are Z,albedo,N,P,object,primitive, not Z",
          "its layers are Z, not Z,albedo,N,P,object,primitive");
  refused({"scene.pbrt", "--seed", "1"}, "its camera, pixel filter, sampler, seed",
          "its camera, pixel filter, sampler, seed");
  refused({"scene.pbrt", "--max-depth", "1"}, "its camera, pixel filter, sampler, seed",
          "its camera, pixel filter, sampler, seed");
  refused({"thick.pbrt"}, "it is of another scene", "it is of another scene");
}

TEST(Films, OtherDevicesAreTold) {
  const fs::path folder = folder_with_scene();
  expect_done(render(folder, {"--film", "a.film"}));
  const Result same = render(folder, {"--film", "a.film", "--spp", "3", "--resume"});
  expect_done(same);
  EXPECT_THAT(same.err, Not(HasSubstr("was made on")));
  for (const char* note : {"caplet.device", "caplet.driver", "software"}) {
    SavedFilm film = load_film(folder / "a.film");
    film.notes[note] = "another one";
    save_film(folder / "b.film", film);
    const Result other = render(folder, {"--film", "b.film", "--spp", "4", "--resume"});
    expect_done(other);
    EXPECT_THAT(other.err, AllOf(HasSubstr("b.film was made on"), HasSubstr("another one")));
    EXPECT_THAT(load_film(folder / "b.film").notes.at(note), HasSubstr("another one, "));
    expect_done(render(folder, {"--film", "c.film", "--samples", "4:5"}));
    const Result sum = merge(folder, {"b.film", "c.film", "-o", "sum.exr"});
    expect_done(sum);
    EXPECT_THAT(sum.err, AllOf(HasSubstr("b.film was made on"), HasSubstr("another one")));
  }
}

TEST(Films, OptionsThatDoNotGoTogetherAreRefused) {
  const fs::path folder = folder_with_scene();
  expect_done(render(folder, {"--film", "a.film"}));
  const auto refused = [&](const Names& arguments, const char* why) {
    const Result result = render(folder, arguments);
    EXPECT_EQ(result.code, 2) << why;
    EXPECT_THAT(result.err, HasSubstr(why));
  };
  refused({"--stereo", "0.1", "--film", "b.film"}, "--film: does not go with --stereo");
  refused({"--turntable", "2", "-o", "a.##.png", "--resume"},
          "--resume: does not go with --turntable");
  refused({"--stereo", "0.1", "--samples", "0:1"}, "--samples: does not go with --stereo");
  refused({"-o", "/dev/null", "--checkpoint", "1"}, "--checkpoint: --film FILE tells");
  refused({"--film", "/dev/null", "--resume"}, "--film: checkpoints and --resume need a file");
  refused({"--samples", "1:2", "--film", "a.film", "--resume"},
          "a.film: this film has the samples 0:2, and those asked for begin at 1");
  refused({"--checkpoint", "0"}, "--checkpoint");
  test::write_file(folder / "text.film", "no film");
  refused({"--film", "text.film", "--resume"}, "text.film");
  EXPECT_EQ(test::read_file(folder / "text.film"), "no film");
  const auto merge_refused = [&](const Names& arguments, const char* why) {
    const Result result = merge(folder, arguments);
    EXPECT_EQ(result.code, 2) << why;
    EXPECT_THAT(result.err, HasSubstr(why));
  };
  merge_refused({"a.film"}, "-o: is missing");
  merge_refused({"-o", "a.exr"}, "FILM");
  merge_refused({"missing.film", "-o", "a.exr"}, "missing.film");
  merge_refused(
      {"a.film", "a.film", "-o", "a.exr"},
      "a.film: does not go with a.film: samples 0 to 2 of pixel 0,0 would be in the film twice");
  merge_refused({"a.film", "--film", "a.film"}, "a.film");
  merge_refused({"a.film", "-o", "a.xyz"}, "-o");
  merge_refused({"a.film", "-o", "a.exr", "--layers", "variance"},
                "--layers: the films do not have all");
  merge_refused({"a.film", "-o", "a.exr", "--variance"}, "--variance: the films do not have");
  merge_refused({"a.film", "-o", "a.exr", "--background", "#12"}, "--background");
  EXPECT_FALSE(fs::exists(folder / "a.exr"));
}

TEST(Films, PicturesAreDevelopedAsTheSceneAsked) {
  const std::string scene = std::string("ColorSpace \"rec2020\"\n") + test::small_scene;
  const std::size_t film = scene.find("Film \"rgb\"") + 10;
  std::string asked = scene;
  asked.insert(film, " \"float iso\" 250 \"float whitebalance\" 3000 ");
  const fs::path folder = folder_with_scene(asked);
  const Names backgrounds{"", "transparent", "#204060", "sky.png"};
  expect_done(render(folder, {"-o", "sky.png"}));
  for (const std::string& background : backgrounds) {
    Names one{"-o", "whole.exr", "--preview", "whole.png", "--film", "a.film"};
    if (!background.empty()) one.insert(one.end(), {"--background", background});
    one.insert(one.end(), {"--exposure", background.empty() ? "-1.5" : "auto"});
    expect_done(render(folder, one));
    expect_done(merge(folder, {"a.film", "-o", "a.exr", "--preview", "a.png"}));
    test::expect_equal_pictures(folder / "a.exr", folder / "whole.exr");
    EXPECT_EQ(read_exr(folder / "a.exr").space, ColorSpace::rec2020);
    EXPECT_EQ(test::read_file(folder / "a.png"), test::read_file(folder / "whole.png"))
        << background;
  }
  expect_done(render(folder, {"-o", "whole.png", "--background", "sky.png", "--exposure", "0.7"}));
  expect_done(merge(folder, {"a.film", "-o", "a.png", "--exposure", "0.7"}));
  EXPECT_EQ(test::read_file(folder / "a.png"), test::read_file(folder / "whole.png"));
  EXPECT_THAT(merge(folder, {"a.film", "-o", "b.png", "--exposure", "x"}).err,
              HasSubstr("--exposure: 'x'"));
  EXPECT_FALSE(fs::exists(folder / "b.png"));
  // JPEG has no alpha.
  EXPECT_EQ(merge(folder, {"a.film", "-o", "a.jpg", "--background", "transparent"}).code, 2);
  EXPECT_FALSE(fs::exists(folder / "a.jpg"));
  // Another background than the film's, and fewer layers.
  expect_done(render(folder, {"-o", "whole.exr", "--background", "#ff0000", "--layers", "Z"}));
  expect_done(merge(folder, {"a.film", "-o", "a.exr", "--background", "#ff0000", "--layers", "Z"}));
  test::expect_equal_pictures(folder / "a.exr", folder / "whole.exr");
}

TEST(Films, TellWhatIsInThem) {
  const fs::path folder = folder_with_scene();
  expect_done(
      render(folder, {"--spp", "8", "--samples", "2:4", "--film", "a.film", "--crop", "2,3,10,9"}));
  const Result text = run_program({"film", "a.film"}, folder);
  expect_done(text);
  EXPECT_THAT(text.out, AllOf(HasSubstr("24 x 16 pixels, of which 2,3 to 10,9"),
                              HasSubstr("samples      2:4 of 8"),
                              HasSubstr("missing      0:2, 4:8"), HasSubstr("scene.pbrt")));
  const auto json = nlohmann::json::parse(run_program({"film", "a.film", "--json"}, folder).out);
  EXPECT_EQ(json["size"], (nlohmann::json{24, 16}));
  EXPECT_EQ(json["crop"], (nlohmann::json{2, 3, 10, 9}));
  EXPECT_EQ(json["samples"].dump(), "[[2,4]]");
  EXPECT_EQ(json["missing"].dump(), "[[0,2],[4,8]]");
  EXPECT_EQ(json["samples_wanted"], 8);
  EXPECT_EQ(json["layers"].dump(), R"(["Z","albedo","N","P","object","primitive"])");
  EXPECT_EQ(json["seed"], "0");
  EXPECT_EQ(json["scene_hash"].get<std::string>().size(), 32u);
  EXPECT_NE(json["scene_hash"], json["view_hash"]);
  EXPECT_EQ(run_program({"film", "scene.pbrt"}, folder).code, 2);
  const Result sum = merge(folder, {"a.film", "-o", "a.exr"});
  expect_done(sum);
  EXPECT_THAT(sum.err, HasSubstr("samples 0:2, 4:8 are missing"));
}

class StoppedBy : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(All, StoppedBy, testing::Values(SIGINT, SIGTERM, SIGUSR1),
                         [](const auto& number) {
                           return std::string(::sigabbrev_np(number.param));
                         });

TEST_P(StoppedBy, KeepsTheFilmAndSaysSo) {
  const fs::path folder = folder_with_scene();
  test::Running running(
      {"render", "scene.pbrt", "--film", "a.film", "-o", "a.exr", "--spp", endless}, folder, {}, {},
      test::Running::Stderr::terminal);
  ASSERT_TRUE(running.wait_for_stderr("paths/s"));
  running.send(GetParam());
  if (GetParam() == SIGUSR1) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));  // not while the first is pending
    running.send(SIGUSR1);
  }
  const Result result = running.wait(60);
  ASSERT_EQ(result.code, stopped) << result.err << " signal " << result.signal;
  EXPECT_THAT(result.err, AllOf(HasSubstr("interrupted"), HasSubstr("wrote a.film")));
  const std::vector<SampleSpan> samples = samples_in(folder / "a.film");
  ASSERT_EQ(samples.size(), 1u);
  EXPECT_EQ(read_exr(folder / "a.exr").metadata.at("caplet.samples_per_pixel"),
            std::to_string(samples[0].end));
  const std::string spp = std::to_string(samples[0].end + 5);
  expect_done(render(folder, {"--spp", spp, "--film", "a.film", "--resume", "-o", "a.exr"}));
  expect_done(render(folder, {"--spp", spp, "-o", "whole.exr"}));
  test::expect_equal_pictures(folder / "a.exr", folder / "whole.exr");
}

TEST(Checkpoints, SurviveTheEndOfTheProgram) {
  const fs::path folder = folder_with_scene();
  std::mt19937 random(7);
  std::uint32_t samples = 0;
  for (int run = 0; run < 3; ++run) {
    test::Running running({"render", "scene.pbrt", "-o", "a.exr", "--spp", endless, "--size",
                           "200x150", "--checkpoint", "0.1", "--resume"},
                          folder);
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    // Until there is a newer one than that of the run before, and then somewhere in its writing.
    const auto written = [&] {
      std::error_code missing;
      const auto time = fs::last_write_time(folder / "a.film", missing);
      return missing ? fs::file_time_type() : time;
    };
    const auto begin = written();
    while (written() == begin && std::chrono::steady_clock::now() < deadline)
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    std::this_thread::sleep_for(std::chrono::milliseconds(random() % 200));
    running.send(SIGKILL);
    EXPECT_EQ(running.wait().signal, SIGKILL);
    const std::vector<SampleSpan> now = samples_in(folder / "a.film");
    ASSERT_EQ(now.size(), 1u);
    EXPECT_EQ(now[0].begin, 0u);
    EXPECT_GT(now[0].end, samples);
    samples = now[0].end;
  }
  const std::string spp = std::to_string(samples + 1);
  expect_done(render(folder, {"--spp", spp, "--size", "200x150", "-o", "a.exr", "--resume"}));
  expect_done(render(folder, {"--spp", spp, "--size", "200x150", "-o", "whole.exr"}));
  test::expect_equal_pictures(folder / "a.exr", folder / "whole.exr");
  // What killed runs left half-written is gone.
  EXPECT_THAT(test::names_in(folder), ElementsAre("a.exr", "a.film", "scene.pbrt", "whole.exr"));
}

TEST(Checkpoints, AFullDiskKeepsTheOldOneAndTheRenderGoesOn) {
  const fs::path folder = folder_with_scene();
  fs::create_directory(folder / "disk");
  const test::SmallDisk disk(folder / "disk");
  if (!disk.mounted()) GTEST_SKIP() << "mount is not allowed";
  const Names on_disk{"--film", "disk/a.film", "--layers", "none"};
  Names first = on_disk, second{"render", "scene.pbrt"};
  first.insert(first.end(), {"--spp", "1"});
  expect_done(render(folder, first));
  disk.leave(1);
  const std::string before = test::read_file(folder / "disk/a.film");
  second.insert(second.end(), on_disk.begin(), on_disk.end());
  second.insert(second.end(), {"-o", "a.exr", "--spp", endless, "--resume", "--checkpoint", "0.1"});
  test::Running running(second, folder);
  ASSERT_TRUE(
      running.wait_for_stderr("the film keeps its last checkpoint, and the render goes on"));
  running.send(SIGTERM);
  const Result result = running.wait(60);
  EXPECT_EQ(result.code, 1) << result.err;
  EXPECT_THAT(result.err, HasSubstr("error: "));
  EXPECT_EQ(test::read_file(folder / "disk/a.film"), before);
  // The picture is written all the same.
  EXPECT_GT(std::stoi(read_exr(folder / "a.exr").metadata.at("caplet.samples_per_pixel")), 1);
}

}  // namespace
}  // namespace caplet::film_test
