// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Several files, several outputs, and frames: turntables, numbered files, models, movies.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdlib>

#include "film/image.h"
#include "film/preview.h"
#include "program.h"
#include "support/data.h"

namespace caplet::frames_test {
namespace {

namespace fs = std::filesystem;
using test::names_in;
using test::render;
using test::Result;
using test::run_program;
using test::write_file;
using testing::AllOf;
using testing::HasSubstr;

using Names = std::vector<std::string>;

constexpr const char* neuron = "1 1 0 0 0 2 -1\n2 3 3 0 0 1 1\n3 3 6 0 2 0.5 2\n";
constexpr const char* two_frames = "2\nfirst\nC 0 0 0\nO 1.2 0 0\n2\nsecond\nC 0 0 0\nO 0 3 0\n";

fs::path folder_of(const std::map<std::string, std::string>& files) {
  const fs::path folder = test::folder_with_scene();
  fs::remove(folder / "scene.pbrt");
  for (const auto& [name, text] : files) write_file(folder / name, text);
  return folder;
}

Result run(const fs::path& folder, Names arguments) {
  arguments.insert(arguments.begin(), "render");
  for (const char* more : {"-q", "--size", "24x16", "--spp", "4"}) arguments.emplace_back(more);
  return run_program(arguments, folder);
}

void expect_equal(const fs::path& a, const fs::path& b) {
  const LayeredImage one = read_exr(a), other = read_exr(b);
  for (const Channel& channel : one.channels) {
    ASSERT_NE(other.find(channel.name), nullptr);
    EXPECT_EQ(channel.floats, other.find(channel.name)->floats) << b << " " << channel.name;
    EXPECT_EQ(channel.uints, other.find(channel.name)->uints) << b << " " << channel.name;
  }
}
bool differ(const fs::path& a, const fs::path& b) {
  return read_exr(a).find("R")->floats != read_exr(b).find("R")->floats;
}

// What one file says of the picture is said of all, whichever comes first.
TEST(SeveralScenes, AreSeenAsTheOneWithACameraSays) {
  const fs::path folder = folder_of(
      {{"seen.pbrt",
        "LookAt 0 0 -9 0 0 0 0 1 0\nCamera \"perspective\" \"float fov\" 31\n"
        "Film \"rgb\" \"integer xresolution\" 40 \"integer yresolution\" 30\n"
        "PixelFilter \"triangle\"\nSampler \"independent\" \"integer pixelsamples\" 7\n"
        "Integrator \"path\" \"integer maxdepth\" 3\nWorldBegin\nLightSource \"infinite\"\n"
        "Shape \"sphere\"\n"},
       {"other.pbrt", "WorldBegin\nShape \"disk\"\n"}});
  const auto head = [&](std::vector<std::string> files) {
    files.insert(files.begin(), "convert");
    files.emplace_back("-");
    const Result result = run_program(files, folder);
    EXPECT_EQ(result.code, 0) << result.err;
    return result.out.substr(0, result.out.find("WorldBegin"));
  };
  const std::string alone = head({"seen.pbrt"});
  for (const char* said :
       {"\"float fov\"", "\"triangle\"", "\"independent\"", "\"integer maxdepth\" 3"})
    EXPECT_THAT(alone, HasSubstr(said));
  EXPECT_EQ(head({"seen.pbrt", "other.pbrt"}), alone);
  EXPECT_EQ(head({"other.pbrt", "seen.pbrt"}), alone);
}

TEST(SeveralScenes, AreInOnePicture) {
  const fs::path folder =
      folder_of({{"a.swc", neuron}, {"b.swc", "1 2 0 9 0 1 -1\n2 2 4 9 0 1 1\n"}});
  ASSERT_EQ(run(folder, {"a.swc", "b.swc", "-o", "out.exr"}).code, 0);
  EXPECT_EQ(read_exr(folder / "out.exr").metadata.at("caplet.scene"), "a.swc b.swc");
  const Result info = run_program({"info", "a.swc", "b.swc"}, folder);
  EXPECT_THAT(info.out, HasSubstr("capsule      3\n"));
  const Result pick = run_program({"pick", "a.swc", "b.swc", "--ray", "2,9,9,0,0,-1"}, folder);
  EXPECT_THAT(pick.out, HasSubstr("b"));
  const Result verify = run_program({"verify", "a.swc", "b.swc", "--rays", "1000", "-q"}, folder);
  EXPECT_EQ(verify.code, 0) << verify.err;
  // The same picture from one file.
  ASSERT_EQ(run_program({"convert", "a.swc", "b.swc", "both.pbrt", "-q"}, folder).code, 0);
  ASSERT_EQ(run(folder, {"both.pbrt", "-o", "both.exr"}).code, 0);
  expect_equal(folder / "out.exr", folder / "both.exr");
  EXPECT_EQ(run_program({"convert", "a.swc"}, folder).code, 2);
}

TEST(SeveralOutputs, AreOfOneRender) {
  const fs::path folder = test::folder_with_scene();
  const Result result = render(
      folder, {"-o", "a.exr", "-o", "b.png", "-o", "c.exr", "-o", "d.jpg", "--preview", "e.png"});
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(names_in(folder), (Names{"a.exr", "b.png", "c.exr", "d.jpg", "e.png", "scene.pbrt"}));
  expect_equal(folder / "a.exr", folder / "c.exr");
  EXPECT_EQ(test::read_file(folder / "b.png"), test::read_file(folder / "e.png"));
  const fs::path alone = test::folder_with_scene();
  ASSERT_EQ(render(alone, {"-o", "b.png"}).code, 0);
  EXPECT_EQ(names_in(alone), (Names{"b.png", "scene.pbrt"}));
  EXPECT_EQ(test::read_file(alone / "b.png"), test::read_file(folder / "b.png"));
}

TEST(Frames, ATurntableGoesRoundOnce) {
  const fs::path folder = folder_of({{"a.swc", neuron}});
  ASSERT_EQ(run(folder, {"a.swc", "--turntable", "4", "-o", "t.##.exr", "-o", "p%d.png"}).code, 0);
  EXPECT_EQ(names_in(folder), (Names{"a.swc", "p1.png", "p2.png", "p3.png", "p4.png", "t.01.exr",
                                     "t.02.exr", "t.03.exr", "t.04.exr"}));
  EXPECT_TRUE(differ(folder / "t.01.exr", folder / "t.02.exr"));
  EXPECT_TRUE(differ(folder / "t.01.exr", folder / "t.03.exr"));
  // Each by itself is the same, whatever was rendered before it.
  ASSERT_EQ(run(folder, {"a.swc", "--turntable", "4", "--frames", "3-3", "-o", "again.#.exr"}).code,
            0);
  expect_equal(folder / "t.03.exr", folder / "again.3.exr");
  EXPECT_FALSE(fs::exists(folder / "again.1.exr"));
}

TEST(Frames, HaveTheExposureOfTheFirst) {
  const fs::path folder = test::folder_with_scene(
      "Film \"rgb\" \"integer xresolution\" 24 \"integer yresolution\" 16 LookAt 0 0 6 0 0 0 0 1 0 "
      "Camera \"perspective\" Sampler \"sobol\" \"integer pixelsamples\" 4 WorldBegin "
      "LightSource \"distant\" \"point3 from\" [1 0 2] Shape \"sphere\"");
  ASSERT_EQ(run(folder, {"scene.pbrt", "--turntable", "4", "-o", "t.#.exr", "-o", "t.#.png",
                         "--exposure", "auto"})
                .code,
            0);
  std::vector<double> own;
  for (const char* frame : {"t.1", "t.2", "t.3", "t.4"}) {
    LayeredImage picture = read_exr(folder / (frame + std::string(".exr")));
    picture.chromaticities.reset();
    ExposureMeter meter;
    meter.add(picture);
    own.push_back(meter.stops());
    picture.exposure.stops = own.front();
    EXPECT_EQ(FileImageReader().read_texture(folder / (frame + std::string(".png")), {}).bytes,
              preview_rgb8(picture))
        << frame;
  }
  EXPECT_GT(std::ranges::max(own), own.front() + 0.5) << "the dark side is seen";
}

// A camera that the file says goes round what is up there, and lights stay: of a scene that is the
// same all round, frames differ by them alone. Half a turn of a ball with a light at the camera's
// side leaves the dark side.
TEST(Frames, OnlyTheCameraOfAFileMoves) {
  const fs::path folder = test::folder_with_scene(
      "LookAt 0 0 5  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 40\n"
      "Film \"rgb\" \"integer xresolution\" 9 \"integer yresolution\" 9\nWorldBegin\n"
      "LightSource \"distant\" \"point3 from\" [0 0 1] \"point3 to\" [0 0 0]\nShape \"sphere\"\n");
  ASSERT_EQ(render(folder, {"--turntable", "2", "-o", "f#.exr", "--spp", "4"}).code, 0);
  const auto middle = [&](const char* name) {
    return read_exr(folder / name).find("R")->floats.at(40);
  };
  EXPECT_GT(middle("f1.exr"), 0.1F);
  EXPECT_EQ(middle("f2.exr"), 0.0F);
  const LayeredImage first = read_exr(folder / "f1.exr"), second = read_exr(folder / "f2.exr");
  EXPECT_NEAR(first.find("Z")->floats.at(40), 4, 0.1);
  EXPECT_NEAR(second.find("Z")->floats.at(40), 4, 0.1);
}

TEST(Frames, ModelsFollowEachOtherBeforeOneCamera) {
  const fs::path folder = folder_of({{"m.xyz", two_frames}});
  ASSERT_EQ(run_program({"render", "m.xyz", "--frames", "all", "-o", "m#.exr", "-q", "--size",
                         "96x64", "--spp", "1"},
                        folder)
                .code,
            0);
  EXPECT_EQ(names_in(folder), (Names{"m.xyz", "m1.exr", "m2.exr"}));
  EXPECT_TRUE(differ(folder / "m1.exr", folder / "m2.exr"));
  // Nothing is cut off, though the second frame is three times as large: no object at the rim.
  for (const char* name : {"m1.exr", "m2.exr"}) {
    const LayeredImage image = read_exr(folder / name);
    const Channel& ids = *image.find("object.id");
    constexpr std::uint32_t nothing = 0xffffffff;
    std::size_t seen = 0;
    for (int y = 0; y < 64; ++y)
      for (int x = 0; x < 96; ++x) {
        const std::uint32_t id = ids.uints.at(static_cast<std::size_t>(96 * y + x));
        seen += id != nothing;
        if (x == 0 || y == 0 || x == 95 || y == 63) {
          EXPECT_EQ(id, nothing) << name << " " << x << " " << y;
        }
      }
    EXPECT_GT(seen, 3U);
  }
}

TEST(Frames, NumberedFilesFollowEachOther) {
  const fs::path folder =
      folder_of({{"n.01.swc", neuron}, {"n.02.swc", "1 1 0 0 0 2 -1\n2 3 3 4 0 1 1\n"}});
  ASSERT_EQ(run(folder, {"n.##.swc", "--frames", "1-2", "-o", "n.##.exr"}).code, 0);
  EXPECT_TRUE(differ(folder / "n.01.exr", folder / "n.02.exr"));
}

TEST(Frames, WhatIsThereMayStay) {
  const fs::path folder = folder_of({{"a.swc", neuron}});
  write_file(folder / "t2.exr", "mine");
  ASSERT_EQ(run(folder, {"a.swc", "--turntable", "3", "--skip-existing", "-o", "t#.exr"}).code, 0);
  EXPECT_EQ(test::read_file(folder / "t2.exr"), "mine");
  EXPECT_EQ(names_in(folder), (Names{"a.swc", "t1.exr", "t2.exr", "t3.exr"}));
}

/// A program that notes its arguments and the number of pictures, and writes what is asked for.
std::map<std::string, std::string> with_stand_in(const fs::path& folder) {
  const fs::path bin = folder.parent_path() / (folder.filename().string() + "-bin");
  fs::create_directories(bin);
  write_file(bin / "ffmpeg",
             "#!/bin/sh\nfor last; do :; done\npictures=\"\"\nwhile [ $# -gt 0 ]; do [ \"$1\" = -i "
             "] && pictures=\"$2\"; shift; done\n"
             "ls \"$(dirname \"$pictures\")\" | grep -c png > \"$last\"\n");
  ::chmod((bin / "ffmpeg").c_str(), 0755);
  return {{"PATH", bin.string() + ":" + std::getenv("PATH")}};
}

TEST(Frames, FfmpegMakesAMovie) {
  const fs::path folder = folder_of({{"a.swc", neuron}});
  const Names arguments{"render", "a.swc",  "--turntable", "3",     "-o", "m.mp4",
                        "-q",     "--size", "24x16",       "--spp", "1"};
  const Result result = run_program(arguments, folder, with_stand_in(folder));
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(names_in(folder), (Names{"a.swc", "m.mp4"}));
  EXPECT_EQ(test::read_file(folder / "m.mp4"), "3\n");
  const Result without = run_program(arguments, folder, {{"PATH", "/nowhere"}});
  EXPECT_EQ(without.code, 2);
  EXPECT_THAT(without.err, AllOf(HasSubstr("-o"), HasSubstr("install the package ffmpeg")));
}

TEST(Frames, AnInterruptLeavesWholeOnes) {
  const fs::path folder = folder_of({{"a.swc", neuron}});
  test::Running running({"render", "a.swc", "--turntable", "1000", "-o", "t.####.exr", "--size",
                         "64x48", "--spp", "4"},
                        folder);
  ASSERT_TRUE(running.wait_for_stderr("frame 2: wrote"));
  running.send(SIGINT);
  const Result result = running.wait();
  EXPECT_EQ(result.code, 1);
  EXPECT_THAT(result.err, HasSubstr("of 1000 frames are written"));
  const Names names = names_in(folder);
  ASSERT_GE(names.size(), 3U);
  EXPECT_LT(names.size(), 900U);
  for (const std::string& name : names)
    if (name != "a.swc") {
      EXPECT_EQ(read_exr(folder / name).metadata.at("caplet.interrupted"), "no") << name;
    }
}

// The parts of a scene where a line of a file of poses puts them.
struct Posed {
  const char* eye = "0 0 9";
  const char* ball = "1 0 0 0  0 1 0 0  0 0 1 0  -1 0 0 1";  // columns
  const char* rod = "\"point3 p0\" [ 0 -1 0 ] \"point3 p1\" [ 0 1 0 ] \"float radius\" [ 0.2 0.2 ]";
  const char* bead = "1 0 0 0  0 1 0 0  0 0 1 0  1 1 0 1";
  const char* fov = "40";
  std::string text() const {
    return fmt::format(
        "Scale -1 1 1\nLookAt {} 0 0 0 0 1 0\nCamera \"perspective\" \"float fov\" {}\n"
        "WorldBegin\nLightSource \"infinite\"\nLightSource \"point\" \"point3 from\" [ 3 4 9 ] "
        "\"float scale\" 50\n"
        "AttributeBegin\nTransform [ {} ]\nShape \"sphere\" \"string name\" "
        "\"ball\"\nAttributeEnd\n"
        "Shape \"capsule\" {} \"string name\" \"rod\"\n"
        "ObjectBegin \"bead\"\nShape \"sphere\" \"float radius\" 0.4\nObjectEnd\n"
        "AttributeBegin\nTransform [ {} ]\nObjectInstance \"bead\"\nAttributeEnd\n",
        eye, fov, ball, rod, bead);
  }
};

TEST(Frames, AreThePosesOfAFile) {
  const Posed still;
  const Posed moved{.ball = "1 0 0 0  0 2 0 0  0 0 1 0  -1 0.5 0 1"};
  const Posed seen{.eye = "4 3 8", .fov = "60"};
  const Posed all{.eye = "0 0 9",
                  .ball = "1 0 0 0  0 1 0 0  0 0 1 0  0.5 0 0 1",
                  .rod =
                      "\"point3 p0\" [ -2 -1 0 ] \"point3 p1\" [ -1 1 0 ] \"float radius\" [ "
                      "0.1 0.3 ]",
                  .bead = "1 0 0 0  0 1 0 0  0 0 1 0  1 -1 0 1"};
  const fs::path folder = folder_of(
      {{"still.pbrt", still.text()},
       {"1.pbrt", moved.text()},
       {"2.pbrt", seen.text()},
       {"3.pbrt", all.text()},
       {"4.pbrt", still.text()},
       {"poses.jsonl",
        "{\"shapes\": {\"ball\": [1, 0, 0, -1, 0, 2, 0, 0.5, 0, 0, 1, 0]}}\n"
        "  \n"
        "{\"camera\": {\"eye\": [4, 3, 8], \"target\": [0, 0, 0], \"fov\": 60}}\r\n"
        "{\"shapes\": {\"ball\": [[1, 0, 0, 0.5], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]}, "
        "\"capsules\": {\"rod\": {\"p0\": [-2, -1, 0], \"p1\": [[-1, 1, 0]], \"radius\": [[0.1, "
        "0.3]]}}, \"instances\": {\"0\": [1, 0, 0, 1, 0, 1, 0, -1, 0, 0, 1, 0]}}\n"
        "{}"}});
  const Result result =
      run(folder, {"still.pbrt", "--poses", "poses.jsonl", "-o", "pose.#.exr", "-o", "pose.#.png"});
  ASSERT_EQ(result.code, 0) << result.err;
  for (const char* number : {"1", "2", "3", "4"}) {
    const fs::path posed = folder / fmt::format("pose.{}.exr", number);
    ASSERT_EQ(run(folder, {fmt::format("{}.pbrt", number), "-o", "alone.exr"}).code, 0);
    expect_equal(posed, folder / "alone.exr");
    EXPECT_TRUE(fs::exists(folder / fmt::format("pose.{}.png", number)));
  }
  EXPECT_TRUE(differ(folder / "pose.1.exr", folder / "pose.4.exr"));
  EXPECT_TRUE(differ(folder / "pose.2.exr", folder / "pose.4.exr"));
  EXPECT_TRUE(differ(folder / "pose.3.exr", folder / "pose.4.exr"));
  ASSERT_EQ(
      run(folder, {"still.pbrt", "--poses", "poses.jsonl", "--frames", "3", "-o", "only#.exr"})
          .code,
      0);
  expect_equal(folder / "only3.exr", folder / "pose.3.exr");
  EXPECT_FALSE(fs::exists(folder / "only2.exr"));
}

// Poses with times are keys: frames are between them, and while the shutter is open the picture is
// that of a scene file whose camera and instance move so.
TEST(Frames, AreAnAnimationBetweenPosesWithTimes) {
  const auto scene = [](const std::string& camera, const std::string& bead) {
    return "Scale -1 1 1\n" + camera +
           "Camera \"perspective\" \"float fov\" 40\nWorldBegin\nLightSource \"infinite\"\n"
           "LightSource \"point\" \"point3 from\" [ 3 4 9 ] \"float scale\" 50\n"
           "Shape \"sphere\"\nObjectBegin \"bead\"\nShape \"sphere\" \"float radius\" 0.4\n"
           "ObjectEnd\nAttributeBegin\n" +
           bead + "ObjectInstance \"bead\"\nAttributeEnd\n";
  };
  const auto moving = [](const std::string& from, const std::string& to) {
    return "ActiveTransform StartTime\n" + from + "ActiveTransform EndTime\n" + to +
           "ActiveTransform All\n";
  };
  const std::string first = "LookAt 0 0 9 0 0 0 0 1 0\n", middle = "LookAt 2 0 9 2 0 0 0 1 0\n";
  const fs::path folder =
      folder_of({{"1.pbrt", scene(first, "Translate 1 1 0\n")},
                 {"2.pbrt", scene(middle, "Translate 1 0 0\n")},
                 {"3.pbrt", scene("LookAt 4 0 9 4 0 0 0 1 0\n", "Translate 1 -1 0\n")},
                 {"open.pbrt",
                  scene(moving(first, middle), moving("Translate 1 1 0\n", "Translate 1 0 0\n"))},
                 {"poses.jsonl",
                  "{\"time\": 7, \"camera\": {\"eye\": [0, 0, 9], \"target\": [0, 0, 0]}, "
                  "\"instances\": {\"0\": [1, 0, 0, 1, 0, 1, 0, 1, 0, 0, 1, 0]}}\n"
                  "{\"time\": 8, \"camera\": {\"eye\": [4, 0, 9], \"target\": [4, 0, 0]}, "
                  "\"instances\": {\"0\": [1, 0, 0, 1, 0, 1, 0, -1, 0, 0, 1, 0]}}\n"}});
  const Names animated{"1.pbrt", "--poses", "poses.jsonl", "--fps", "2"};
  const auto with = [&](Names more) {
    more.insert(more.begin(), animated.begin(), animated.end());
    return run(folder, more);
  };
  const Result result = with({"-o", "a#.exr"});
  ASSERT_EQ(result.code, 0) << result.err;
  for (const char* number : {"1", "2", "3"}) {
    ASSERT_EQ(run(folder, {fmt::format("{}.pbrt", number), "-o", "alone.exr"}).code, 0);
    expect_equal(folder / fmt::format("a{}.exr", number), folder / "alone.exr");
  }
  EXPECT_FALSE(fs::exists(folder / "a4.exr"));
  ASSERT_EQ(with({"--shutter", "1", "--frames", "1", "-o", "open#.exr"}).code, 0);
  ASSERT_EQ(run(folder, {"open.pbrt", "-o", "file.exr"}).code, 0);
  // Five keys on a line instead of two: positions differ by roundings, which move edges a little.
  const std::vector<float> is = read_exr(folder / "open1.exr").find("R")->floats,
                           wanted = read_exr(folder / "file.exr").find("R")->floats;
  ASSERT_EQ(is.size(), wanted.size());
  std::size_t apart = 0;
  for (std::size_t i = 0; i < is.size(); ++i)
    apart += std::abs(is[i] - wanted[i]) > 1e-3F * (1 + wanted[i]);
  EXPECT_LE(apart, is.size() / 50);
  EXPECT_TRUE(differ(folder / "open1.exr", folder / "a1.exr"));

  EXPECT_THAT(with({"--frames", "4", "-o", "b#.exr"}).err, HasSubstr("there are 3 frames"));
  write_file(folder / "far.jsonl", "{\"time\": 0}\n{\"time\": 1e9}\n");
  EXPECT_THAT(run(folder, {"1.pbrt", "--poses", "far.jsonl", "-o", "b#.exr"}).err,
              HasSubstr("there are 2.5e+10 frames from 0 s to 1e+09 s"));
  write_file(folder / "still.jsonl", "{}\n");
  EXPECT_THAT(
      run(folder, {"1.pbrt", "--poses", "still.jsonl", "--shutter", "0.5", "-o", "b#.exr"}).err,
      HasSubstr("--shutter: goes with --turntable, --frames, --play, and --poses that have times"));
}

// A scene that moves is played: frames are those of files in which everything is where it is then,
// or of a file whose shutter is open for as long. Poses move what they name beside it.
TEST(Frames, AreThoseOfASceneThatMoves) {
  const auto scene = [](const std::string& bead, const std::string& more = "",
                        const std::string& eye = "0 0 8") {
    return fmt::format(
        "Option \"string rendercoordsys\" \"world\"\nLookAt {} 0 0 0 0 1 0\n"
        "Camera \"perspective\" \"float fov\" 40 {}\nWorldBegin\nLightSource \"infinite\"\n"
        "LightSource \"point\" \"point3 from\" [ 3 4 9 ] \"float scale\" 50\n"
        "ObjectBegin \"bead\"\nShape \"sphere\" \"float radius\" 0.5\nObjectEnd\n"
        "AttributeBegin\n{}ObjectInstance \"bead\"\nAttributeEnd\n",
        eye, more, bead);
  };
  const std::string moves =
      "ActiveTransform StartTime\nTranslate -1 0 0\nActiveTransform EndTime\nTranslate 1 0 0\n"
      "ActiveTransform All\n";
  const fs::path folder = folder_of(
      {{"moves.pbrt", scene(moves)},
       {"1.pbrt", scene("Translate -1 0 0\n")},
       {"2.pbrt", scene("Translate 0 0 0\n")},
       {"3.pbrt", scene("Translate 1 0 0\n")},
       {"3.seen.pbrt", scene("Translate 1 0 0\n", "", "0 0 4")},
       {"open.pbrt", scene(moves, "\"float shutteropen\" 0.5 \"float shutterclose\" 0.75")},
       {"keys.jsonl",
        "{\"time\": 0.5, \"camera\": {\"eye\": [0, 0, 8], \"target\": [0, 0, 0]}}\n"
        "{\"time\": 1, \"camera\": {\"eye\": [0, 0, 4], \"target\": [0, 0, 0]}}\n"}});
  const Result result = run(folder, {"moves.pbrt", "--play", "0:1", "--fps", "2", "-o", "p#.exr"});
  ASSERT_EQ(result.code, 0) << result.err;
  for (const char* number : {"1", "2", "3"}) {
    ASSERT_EQ(run(folder, {fmt::format("{}.pbrt", number), "-o", "alone.exr"}).code, 0);
    expect_equal(folder / fmt::format("p{}.exr", number), folder / "alone.exr");
  }
  EXPECT_FALSE(fs::exists(folder / "p4.exr"));

  ASSERT_EQ(run(folder, {"moves.pbrt", "--play", "0.5:1", "--fps", "2", "--shutter", "0.5",
                         "--frames", "1", "-o", "open#.exr"})
                .code,
            0);
  // Exposed for a quarter of the seconds, this file's picture is a quarter as bright.
  ASSERT_EQ(run(folder, {"open.pbrt", "-o", "file.exr"}).code, 0);
  const std::vector<float> is = read_exr(folder / "open1.exr").find("G")->floats,
                           wanted = read_exr(folder / "file.exr").find("G")->floats;
  ASSERT_EQ(is.size(), wanted.size());
  for (std::size_t i = 0; i < is.size(); ++i) EXPECT_NEAR(is[i], 4 * wanted[i], 1e-5F * is[i]) << i;
  EXPECT_TRUE(differ(folder / "open1.exr", folder / "p2.exr"));

  ASSERT_EQ(run(folder, {"moves.pbrt", "--poses", "keys.jsonl", "--fps", "2", "-o", "k#.exr"}).code,
            0);
  expect_equal(folder / "k1.exr", folder / "p2.exr");
  ASSERT_EQ(run(folder, {"3.seen.pbrt", "-o", "seen.exr"}).code, 0);
  expect_equal(folder / "k2.exr", folder / "seen.exr");
  // A camera that rests between its keys sees what is played.
  const std::string eye = "\"camera\": {\"eye\": [0, 0, 8], \"target\": [0, 0, 0]}}\n";
  write_file(folder / "rest.jsonl", "{\"time\": 0.5, " + eye + "{\"time\": 1, " + eye);
  ASSERT_EQ(run(folder, {"moves.pbrt", "--poses", "rest.jsonl", "--fps", "2", "--shutter", "0.5",
                         "--frames", "1", "-o", "rest#.exr"})
                .code,
            0);
  const std::vector<float> rests = read_exr(folder / "rest1.exr").find("G")->floats;
  for (std::size_t i = 0; i < is.size(); ++i) EXPECT_NEAR(rests[i], is[i], 1e-3F * is[i]) << i;

  const auto refused = [&](Names arguments, const std::string& why) {
    const Result failed = run(folder, arguments);
    EXPECT_EQ(failed.code, 2);
    EXPECT_THAT(failed.err, HasSubstr(why));
  };
  for (const char* text : {"1", "1:", "a:2", "2:1", ":", "0:1x", "0:inf"})
    refused({"moves.pbrt", "--play", text, "-o", "r#.exr"}, "is not A:B, two times in seconds");
  refused({"1.pbrt", "--play", "0:1", "-o", "r#.exr"}, "--play: nothing in the scene moves");
  refused({"moves.pbrt", "--play", "0:1e9", "-o", "r#.exr"}, "--play: there are 2.5e+10 frames");
  refused({"moves.pbrt", "--play", "0:1", "--turntable", "3", "-o", "r#.exr"},
          "--play: does not go with --turntable");
  refused({"moves.pbrt", "--play", "0:1", "--poses", "keys.jsonl", "-o", "r#.exr"},
          "--poses: does not go with --turntable, --play");
}

// A turntable's camera goes on while the shutter is open: for a full share, to the next frame.
TEST(Frames, ATurntableIsBlurredByItsTurn) {
  const fs::path folder = folder_of({{"a.swc", neuron}});
  ASSERT_EQ(run(folder, {"a.swc", "--turntable", "3", "-o", "still#.exr"}).code, 0);
  ASSERT_EQ(
      run(folder, {"a.swc", "--turntable", "3", "--shutter", "0.5", "-o", "blurred#.exr"}).code, 0);
  for (const char* number : {"1", "2", "3"})
    EXPECT_TRUE(differ(folder / fmt::format("still{}.exr", number),
                       folder / fmt::format("blurred{}.exr", number)));
}

// A frame of numbered files goes on towards the next file's while the shutter is open: what both
// have. The last one, which has none, is still. So are the models of a file.
TEST(Frames, OfFilesAreBlurredTowardsTheNext) {
  const auto scene = [](const std::string& shapes, const std::string& camera = "") {
    return "Option \"string rendercoordsys\" \"world\"\nLookAt 0 0 8 0 0 0 0 1 0\n"
           "Camera \"perspective\" \"float fov\" 40 " +
           camera +
           "\nWorldBegin\nLightSource \"infinite\"\nObjectBegin \"bead\"\nShape \"sphere\" \"float "
           "radius\" 0.5\nObjectEnd\n" +
           shapes;
  };
  const auto still = [&](const std::string& x) {
    return scene("Shape \"capsules\" \"point3 p0\" [" + x + " -1 0] \"point3 p1\" [" + x +
                 " -1.5 0] \"float radius\" 0.3\n"
                 "Shape \"trianglemesh\" \"point3 P\" [" +
                 x + " 0 0 1 0 0 0 1 0]\nAttributeBegin\nTranslate " + x +
                 " 2 0\nObjectInstance \"bead\"\nAttributeEnd\n");
  };
  const fs::path folder = folder_of(
      {{"s1.pbrt", still("-1")},
       {"s2.pbrt", still("0.5")},
       {"moves.pbrt",
        scene(
            "Shape \"capsules\" \"float times\" [0 1] \"point3 p0\" [-1 -1 0 0.5 -1 0] \"point3 "
            "p1\" [-1 -1.5 0 0.5 -1.5 0] \"float radius\" 0.3\n"
            "Shape \"trianglemesh\" \"float times\" [0 1] \"point3 P\" [-1 0 0 1 0 0 0 1 0 0.5 0 0 "
            "1 0 0 0 1 0]\nAttributeBegin\nActiveTransform StartTime\nTranslate -1 2 "
            "0\nActiveTransform EndTime\nTranslate 0.5 2 0\nActiveTransform "
            "All\nObjectInstance \"bead\"\nAttributeEnd\n",
            "\"float shutterclose\" 0.5")},
       {"m.xyz", "1\nfirst\nO 0 0 0\n1\nsecond\nO 1 0 0\n"}});
  const Names frames{"s#.pbrt", "--frames", "1-2", "--shutter", "0.5", "-o", "f#.exr"};
  const Result result = run(folder, frames);
  ASSERT_EQ(result.code, 0) << result.err;
  ASSERT_EQ(run(folder, {"moves.pbrt", "-o", "moves.exr"}).code, 0);
  ASSERT_EQ(run(folder, {"s2.pbrt", "-o", "last.exr"}).code, 0);
  expect_equal(folder / "f2.exr", folder / "last.exr");
  // Exposed for half a second, that file's picture is half as bright.
  const std::vector<float> is = read_exr(folder / "f1.exr").find("G")->floats,
                           wanted = read_exr(folder / "moves.exr").find("G")->floats;
  ASSERT_EQ(is.size(), wanted.size());
  for (std::size_t i = 0; i < is.size(); ++i) EXPECT_NEAR(is[i], 2 * wanted[i], 1e-5F * is[i]) << i;
  // A frame does not depend on which are asked for.
  ASSERT_EQ(run(folder, {"s#.pbrt", "--frames", "1", "--shutter", "0.5", "-o", "one#.exr"}).code,
            0);
  expect_equal(folder / "one1.exr", folder / "f1.exr");

  ASSERT_EQ(run(folder, {"m.xyz", "--frames", "all", "-o", "still#.exr"}).code, 0);
  ASSERT_EQ(run(folder, {"m.xyz", "--frames", "all", "--shutter", "1", "-o", "m#.exr"}).code, 0);
  EXPECT_TRUE(differ(folder / "still1.exr", folder / "m1.exr"));
  expect_equal(folder / "still2.exr", folder / "m2.exr");
}

TEST(Frames, SayWhatIsWrongInAFileOfPoses) {
  const fs::path folder = folder_of({{"s.pbrt", Posed().text()}, {"empty.jsonl", "\n \n"}});
  const auto refused = [&](const std::string& line, const std::string& why) {
    write_file(folder / "p.jsonl", "{}\n\n" + line + "\n");
    const Result result = run(folder, {"s.pbrt", "--poses", "p.jsonl", "-o", "t#.exr"});
    EXPECT_EQ(result.code, 2) << line << result.err;
    EXPECT_THAT(result.err, AllOf(HasSubstr("p.jsonl:3"), HasSubstr(why))) << line;
    EXPECT_EQ(names_in(folder), (Names{"empty.jsonl", "p.jsonl", "s.pbrt"})) << line;
  };
  const std::string matrix = "[1,0,0,0, 0,1,0,0, 0,0,1,0]";
  refused("{\"shapes\": ", "p.jsonl:3:12: this is no JSON object");
  refused("[1, 2]", "a pose is a JSON object");
  refused("{\"shapes\": 3}", "shapes is a JSON object");
  refused("{\"shape\": {}}", "a pose has no 'shape'; the nearest is 'shapes'");
  refused("{\"shapes\": {\"bull\": " + matrix + "}}",
          "there is no shape 'bull'; the nearest is 'ball'");
  refused("{\"shapes\": {\"ball\": [1, 2, 3]}}",
          "shape 'ball': 12 or 16 numbers are needed, not 3");
  refused("{\"shapes\": {\"ball\": [\"a\"]}}", "shape 'ball': numbers are needed");
  refused("{\"shapes\": {\"ball\": [[[[1]]]]}}", "shape 'ball': numbers are needed");
  refused("{\"shapes\": {\"ball\": [1e999]}}", "a number is too large");
  refused("{\"shapes\": {\"ball\": [1,0,0,0, 0,0,0,0, 0,0,1,0]}}", "singular");
  refused("{\"instances\": {\"1\": " + matrix + "}}", "there is no instance '1'; there are 1");
  refused("{\"instances\": {\"x\": " + matrix + "}}", "there is no instance 'x'");
  refused("{\"capsules\": {\"ball\": {}}}", "shape 'ball' has no capsules");
  refused("{\"capsules\": {\"rod\": {\"p0\": [1, 2]}}}",
          "p0 of capsules of 'rod': 3 numbers are needed, not 2");
  refused("{\"capsules\": {\"rod\": {\"radius\": [-1]}}}", "capsules of 'rod': ");
  refused("{\"camera\": {\"eye\": [0, 0, 1]}}", "eye and target go together");
  refused("{\"camera\": {\"eye\": [0, 0, 1], \"target\": [0, 0, 1]}}", "no direction");
  refused(
      "{\"camera\": {\"eye\": [0, 0, 1], \"target\": [0, 0, 2], \"transform\": " + matrix + "}}",
      "transform does not go with eye and target");
  refused("{\"camera\": {\"fov\": 190}}", "camera: ");
  const auto refused_flag = [&](Names arguments, const std::string& why) {
    const Result result = run(folder, arguments);
    EXPECT_EQ(result.code, 2) << result.err;
    EXPECT_THAT(result.err, HasSubstr(why));
  };
  refused_flag({"s.pbrt", "--poses", "none.jsonl", "-o", "t#.exr"},
               "none.jsonl: cannot read: No such file");
  refused_flag({"s.pbrt", "--poses", "empty.jsonl", "-o", "t#.exr"},
               "empty.jsonl: it has no poses");
  refused_flag({"s.pbrt", "--poses", ".", "-o", "t#.exr"}, "it is a folder");
  write_file(folder / "t1.exr", "{}\n");
  const Result same = run(folder, {"s.pbrt", "--poses", "t1.exr", "-o", "t#.exr"});
  EXPECT_EQ(same.code, 1);
  EXPECT_THAT(same.err, HasSubstr("'t1.exr' is an input"));
  EXPECT_EQ(test::read_file(folder / "t1.exr"), "{}\n");
  refused_flag({"s.pbrt", "--poses", "p.jsonl", "--turntable", "3", "-o", "t#.exr"},
               "--poses: does not go with --turntable");
}

TEST(Frames, SayWhatIsWrong) {
  const fs::path folder = folder_of({{"a.swc", neuron}, {"m.xyz", two_frames}});
  const Names before = names_in(folder);
  const auto refused = [&](Names arguments, const std::string& flag, const std::string& why) {
    const Result result = run(folder, arguments);
    EXPECT_EQ(result.code, 2) << result.err;
    EXPECT_THAT(result.err, AllOf(HasSubstr(flag), HasSubstr(why)));
    EXPECT_EQ(names_in(folder), before);
  };
  refused({"a.swc", "--turntable", "3", "-o", "t.exr"}, "-o", "t.####.exr");
  refused({"a.swc", "--turntable", "3"}, "-o", "frames need a name");
  refused({"a.swc", "--turntable", "0", "-o", "t#.exr"}, "--turntable", "");
  refused({"a.swc", "--turntable", "3", "--frames", "2-4", "-o", "t#.exr"}, "--frames",
          "there are 3 frames");
  for (const char* frames : {"0-1", "2-1", "a", "1-", "-2", "1-2-3"})
    refused({"a.swc", "--turntable", "3", std::string("--frames=") + frames, "-o", "t#.exr"},
            "--frames", "neither A-B");
  refused({"a.swc", "--frames", "1-2", "-o", "t#.exr"}, "--frames", "the scene has one frame");
  refused({"m.xyz", "--frames", "1-3", "-o", "t#.exr"}, "--frames", "there are 2 frames");
  refused({"m.xyz", "--frames", "all", "--model", "2", "-o", "t#.exr"}, "--model", "does not go");
  refused({"n.#.swc", "--frames", "all", "-o", "t#.exr"}, "--frames", "such as 1-100");
  refused({"n.#.swc", "--frames", "1-2", "-o", "t#.exr"}, "n.1.swc", "no such file");
  refused({"a.swc", "--shutter", "0.5", "-o", "a.exr"}, "--shutter",
          "goes with --turntable, --frames, --poses and --play");
  refused({"a.swc", "-o", "m.mp4"}, "-o", "goes with --turntable, --frames, --poses or --play");
  refused({"a.swc", "-o", "m.xyzzy"}, "-o", "pictures are written as .exr");
  refused({"a.swc", "--skip-existing", "-o", "t.exr"}, "--skip-existing", "goes with");
  refused({"a.swc", "--turntable", "3", "--stereo", "1", "-o", "t#.exr"}, "--stereo",
          "does not go");
  refused({"a.swc", "-o", "none", "-o", "t.exr"}, "-o", "does not go with another");
  refused({"a.swc", "-o", "t.exr", "-o", "t.exr"}, "-o", "t.exr");
}

}  // namespace
}  // namespace caplet::frames_test
