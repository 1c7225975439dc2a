// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The program at work: pictures, JSON, progress, signals.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <nlohmann/json.hpp>

#include "film/image.h"
#include "program.h"
#include "support/data.h"

namespace caplet::program_test {
namespace {

using test::Result;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

/// A folder with scene.pbrt: a grey capsule and an instance-free light, 24 x 16 pixels.
std::filesystem::path folder_with_scene() {
  return test::folder_with_scene(
      "LookAt 0 0 5  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 40\n"
      "Film \"rgb\" \"integer xresolution\" 24 \"integer yresolution\" 16 \"string filename\" "
      "\"pictures/grey.png\"\n"
      "Sampler \"independent\" \"integer pixelsamples\" 4\nWorldBegin\nLightSource \"infinite\" "
      "\"rgb L\" [1 1 1]\n"
      "Material \"diffuse\" \"rgb reflectance\" [.5 .5 .5]\n"
      "Shape \"capsule\" \"point3 p0\" [-.5 0 0] \"point3 p1\" [.5 0 0] \"float radius\" 0.6\n");
}

TEST(Program, HelpAndVersion) {
  const auto folder = test::temporary_folder();
  const Result help = test::run_program({"--help"}, folder);
  EXPECT_EQ(help.code, 0);
  for (const char* command : {"render", "merge", "film", "pick", "verify", "info", "convert",
                              "devices", "doctor", "bench"})
    EXPECT_THAT(help.out, HasSubstr(command));
  EXPECT_THAT(help.out, Not(HasSubstr("try-device")));
  const Result render = test::run_program({"render", "--help"}, folder);
  EXPECT_EQ(render.code, 0);
  for (const char* option :
       {"--spp", "--size", "--crop", "--device", "--seed", "--clamp", "--max-depth", "--time",
        "--layers", "--variance", "--preview", "--quiet", "--stats"})
    EXPECT_THAT(render.out, HasSubstr(option));
  EXPECT_THAT(render.out, Not(HasSubstr("--batch")));
  const Result version = test::run_program({"--version"}, folder);
  EXPECT_EQ(version.code, 0);
  EXPECT_THAT(version.out, testing::StartsWith("caplet "));
}

TEST(Program, BenchHandsItsArgumentsOn) {
  const auto folder = test::temporary_folder();
  const Result own = test::run_program({"bench", "--help"}, folder);
  EXPECT_EQ(own.code, 0);
  EXPECT_THAT(own.out, HasSubstr("Usage: caplet bench"));
  // Where caplet_bench is not built, the error names it.
  const Result handed_on = test::run_program({"bench", "--", "--help"}, folder);
  EXPECT_THAT(handed_on.out + handed_on.err, HasSubstr("caplet_bench"));
  EXPECT_THAT(handed_on.out, Not(HasSubstr("Usage: caplet bench")));
}

// Everything of the model counts: 12 bytes a vertex and 16 a patch, 48 bytes a plane, a Shape (a
// transform alone is 128) an operand.
TEST(Program, InfoCountsTheBytesOfEveryShape) {
  const auto bytes = [](const std::string& shapes) {
    const auto folder = test::temporary_folder();
    test::write_file(folder / "scene.pbrt", "WorldBegin\n" + shapes);
    const Result result = test::run_program({"info", "scene.pbrt", "--json"}, folder);
    EXPECT_EQ(result.code, 0) << result.err;
    return nlohmann::json::parse(result.out).at("bytes").at("host").get<std::int64_t>();
  };
  const auto patches = [](int count) {
    std::string points, indices;
    for (int i = 0; i < count; ++i) {
      for (const char* corner : {" 0 0", " 1 0", " 0 1", " 1 1"})
        points += ' ' + std::to_string(i) + corner;
      for (int k = 0; k < 4; ++k) indices += ' ' + std::to_string(4 * i + k);
    }
    return "Shape \"bilinearmesh\" \"point3 P\" [" + points + "] \"integer indices\" [" + indices +
           "]\n";
  };
  EXPECT_EQ(bytes(patches(101)) - bytes(patches(1)), 100 * (4 * 12 + 16));
  const auto planes = [](int count) {
    std::string points, normals;
    for (int i = 0; i < count; ++i) {
      const std::string axis[] = {" 1 0 0", " -1 0 0", " 0 1 0", " 0 -1 0", " 0 0 1", " 0 0 -1"};
      points += axis[i % 6];
      normals += axis[i % 6];
    }
    return "Shape \"polyhedron\" \"point3 P\" [" + points + "] \"normal N\" [" + normals + "]\n";
  };
  EXPECT_EQ(bytes(planes(106)) - bytes(planes(6)), 100 * 48);
  const auto operands = [](int count) {
    std::string objects, names;
    for (int i = 0; i < count; ++i) {
      const std::string name = "\"o" + std::to_string(i) + "\" ";
      objects += "ObjectBegin " + name + "Shape \"sphere\" \"float radius\" " +
                 std::to_string(i + 1) + " ObjectEnd\n";
      names += name;
    }
    return objects + "Shape \"csg\" \"string operation\" \"union\" \"string operands\" [" + names +
           "]\n";
  };
  EXPECT_GE(bytes(operands(22)) - bytes(operands(2)), 20 * 128);
}

TEST(Program, DevicesAsJson) {
  const Result result = test::run_program({"devices", "--json"}, test::temporary_folder());
  EXPECT_EQ(result.code, 0);
  const auto devices = nlohmann::json::parse(result.out);
  ASSERT_GE(devices.size(), 1u);
  for (std::size_t i = 0; i < devices.size(); ++i) {
    EXPECT_EQ(devices[i].at("index"), i);
    for (const char* key : {"name", "type", "vendor", "driver", "compute_units", "global_bytes"})
      EXPECT_TRUE(devices[i].contains(key)) << key;
  }
  const Result none = test::run_program(
      {"devices", "--json"}, test::temporary_folder(),
      {{"OCL_ICD_VENDORS", "/nonexistent"}, {"OPENCL_VENDOR_PATH", "/nonexistent"}});
  EXPECT_EQ(none.code, 0);
  EXPECT_EQ(nlohmann::json::parse(none.out).size(), 0u);
}

TEST(Program, InfoAsJson) {
  const Result result = test::run_program({"info", "scene.pbrt", "--json"}, folder_with_scene());
  ASSERT_EQ(result.code, 0) << result.err;
  const auto info = nlohmann::json::parse(result.out);
  EXPECT_EQ(info.at("primitives"), (nlohmann::json{{"capsule", 1}}));
  const auto& low = info.at("bounds").at("min");
  const auto& high = info.at("bounds").at("max");
  ASSERT_EQ(low.size(), 3u);
  // p0 - r and p1 + r along x, with the radius as a float.
  EXPECT_NEAR(low[0].get<double>(), -1.1, 1e-6);
  EXPECT_NEAR(high[0].get<double>(), 1.1, 1e-6);
  EXPECT_NEAR(high[1].get<double>(), 0.6, 1e-6);
  EXPECT_GE(info.at("materials").get<int>(), 1);
  EXPECT_EQ(info.at("lights"), 1);
  EXPECT_GT(info.at("bytes").at("host").get<double>(), 0);
  EXPECT_GT(info.at("bytes").at("device").get<double>(), 0);
  EXPECT_GE(info.at("bvh").at("nodes").get<int>(), 1);
  EXPECT_GE(info.at("bvh").at("depth").get<int>(), 1);
  EXPECT_GT(info.at("bvh").at("sah").get<double>(), 0);
  EXPECT_EQ(test::run_program({"info", "scene.pbrt"}, folder_with_scene()).code, 0);
}

TEST(Program, InfoCountsANeuron) {
  CAPLET_NEEDS_DATA();
  const auto file = test::data_folder() / "swc/neuromorpho_large/173000.swc";
  const Result result =
      test::run_program({"info", file.string(), "--json"}, test::temporary_folder());
  ASSERT_EQ(result.code, 0) << result.err;
  const auto primitives = nlohmann::json::parse(result.out).at("primitives");
  EXPECT_EQ(primitives.at("capsule"), 28929);  // segments, by NOTICE.md's independent count
}

TEST(Program, RendersLayersStatsAndMetadata) {
  const auto folder = folder_with_scene();
  const Result result = test::run_program({"render", "scene.pbrt", "-o", "out.exr", "--stats",
                                           "stats.json", "--seed", "5", "--variance"},
                                          folder);
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(result.out, "");
  EXPECT_EQ(test::names_in(folder),
            (std::vector<std::string>{"out.exr", "scene.pbrt", "stats.json"}));
  const LayeredImage image = read_exr(folder / "out.exr");
  EXPECT_EQ(image.data_width, 24);
  EXPECT_EQ(image.data_height, 16);
  for (const char* name : {"R", "G", "B", "A", "Z", "albedo.R", "N.X", "P.Z", "variance.B",
                           "object.id", "primitive.id"})
    EXPECT_NE(image.find(name), nullptr) << name;
  EXPECT_EQ(image.metadata.at("caplet.samples_per_pixel"), "4");
  EXPECT_EQ(image.metadata.at("caplet.seed"), "5");
  EXPECT_EQ(image.metadata.at("caplet.scene"), "scene.pbrt");
  EXPECT_THAT(image.metadata.at("caplet.command"),
              AllOf(HasSubstr("render "), HasSubstr("scene.pbrt -o out.exr")));
  for (const char* name : {"caplet.version", "caplet.device", "caplet.driver", "caplet.max_depth",
                           "caplet.render_seconds"})
    EXPECT_NE(image.metadata.at(name), "") << name;

  const auto stats = nlohmann::json::parse(test::read_file(folder / "stats.json"));
  for (const char* key : {"load", "build", "compile", "render", "total"})
    EXPECT_GE(stats.at("seconds").at(key).get<double>(), 0) << key;
  EXPECT_GT(stats.at("seconds").at("total").get<double>(),
            stats.at("seconds").at("render").get<double>());
  EXPECT_EQ(stats.at("samples_per_pixel"), 4);
  EXPECT_EQ(stats.at("rays").at("camera"), 24 * 16 * 4);
  EXPECT_GT(stats.at("rays").at("bounce").get<double>(), 0);
  EXPECT_GE(stats.at("rays").at("shadow").get<double>(), 0);
  EXPECT_EQ(stats.at("device"), image.metadata.at("caplet.device"));
  EXPECT_GT(stats.at("peak_bytes").get<double>(), 1e6);
}

TEST(Program, NamesTheOutputAfterTheScene) {
  const auto folder = folder_with_scene();
  ASSERT_EQ(test::run_program({"render", "scene.pbrt", "--spp", "1", "--quiet"}, folder).code, 0);
  EXPECT_EQ(test::names_in(folder), (std::vector<std::string>{"grey.exr", "scene.pbrt"}));
}

TEST(Program, CommandLineOverridesTheFile) {
  const auto folder = folder_with_scene();
  const Result result =
      test::run_program({"render", "scene.pbrt", "-o", "out.exr", "--size", "32x20", "--crop",
                         "5,3,15,9", "--spp", "2", "--max-depth", "1"},
                        folder);
  ASSERT_EQ(result.code, 0) << result.err;
  const LayeredImage image = read_exr(folder / "out.exr");
  EXPECT_EQ(image.width, 32);
  EXPECT_EQ(image.height, 20);
  EXPECT_EQ(image.x, 5);
  EXPECT_EQ(image.y, 3);
  EXPECT_EQ(image.data_width, 10);
  EXPECT_EQ(image.data_height, 6);
  EXPECT_EQ(image.metadata.at("caplet.samples_per_pixel"), "2");
  EXPECT_EQ(image.metadata.at("caplet.max_depth"), "1");
}

TEST(Program, BatchesDoNotChangeThePicture) {
  const auto folder = folder_with_scene();
  ASSERT_EQ(test::run_program({"render", "scene.pbrt", "-o", "a.exr"}, folder).code, 0);
  ASSERT_EQ(
      test::run_program({"render", "scene.pbrt", "-o", "b.exr", "--batch", "64"}, folder).code, 0);
  const LayeredImage a = read_exr(folder / "a.exr"), b = read_exr(folder / "b.exr");
  for (const Channel& channel : a.channels) {
    EXPECT_EQ(channel.floats, b.find(channel.name)->floats) << channel.name;
    EXPECT_EQ(channel.uints, b.find(channel.name)->uints) << channel.name;
  }
}

TEST(Program, QuietSaysNothing) {
  const Result result =
      test::run_program({"render", "scene.pbrt", "-o", "out.exr", "--quiet"}, folder_with_scene());
  EXPECT_EQ(result.code, 0);
  EXPECT_EQ(result.err, "");
  EXPECT_EQ(result.out, "");
}

TEST(Program, PlainLinesWithoutATerminalAndABarOnOne) {
  const auto folder = folder_with_scene();
  const Result plain = test::run_program({"render", "scene.pbrt", "-o", "out.exr"}, folder);
  EXPECT_EQ(plain.code, 0);
  EXPECT_THAT(plain.err, AllOf(Not(HasSubstr("\r")), Not(HasSubstr("\x1b")), HasSubstr("100 %"),
                               HasSubstr("wrote out.exr")));
  const Result terminal = test::run_on_terminal({"render", "scene.pbrt", "-o", "out.exr", "--spp",
                                                 "256", "--size", "96x64", "--batch", "65536"},
                                                folder);
  EXPECT_EQ(terminal.code, 0) << terminal.err;
  EXPECT_THAT(terminal.err, AllOf(HasSubstr("\r["), HasSubstr("256 samples")));
}

#ifdef CAPLET_WITH_OIIO
TEST(Program, WritesAPreview) {
  const auto folder = folder_with_scene();
  const Result result =
      test::run_program({"render", "scene.pbrt", "-o", "out.exr", "--preview", "out.png"}, folder);
  ASSERT_EQ(result.code, 0) << result.err;
  const EnvironmentImage png = FileImageReader().read_rgb(folder / "out.png");
  EXPECT_EQ(png.width, 24);
  EXPECT_EQ(png.height, 16);
}
#endif

TEST(Program, CtrlCWritesTheFinishedPasses) {
  const auto folder = folder_with_scene();
  test::Running running({"render", "scene.pbrt", "-o", "out.exr", "--spp", "16000000"}, folder);
  ASSERT_TRUE(running.wait_for_stderr("paths/s"));  // the first progress line, after five seconds
  running.send(SIGINT);
  const Result result = running.wait();
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_THAT(result.err, HasSubstr("interrupted"));
  EXPECT_EQ(test::names_in(folder), (std::vector<std::string>{"out.exr", "scene.pbrt"}));
  const LayeredImage image = read_exr(folder / "out.exr");
  EXPECT_EQ(image.metadata.at("caplet.interrupted"), "yes");
  const int samples = std::stoi(image.metadata.at("caplet.samples_per_pixel"));
  EXPECT_GE(samples, 1);
  EXPECT_LT(samples, 16000000);
}

TEST(Program, KillingItLeavesThePreviousFile) {
  const auto folder = folder_with_scene();
  test::write_file(folder / "out.exr", "the previous picture");
  test::Running running({"render", "scene.pbrt", "-o", "out.exr", "--spp", "16000000"}, folder);
  ASSERT_TRUE(running.wait_for_stderr("samples per pixel on"));
  running.send(SIGKILL);
  EXPECT_EQ(running.wait().signal, SIGKILL);
  EXPECT_EQ(test::read_file(folder / "out.exr"), "the previous picture");
  EXPECT_EQ(test::names_in(folder), (std::vector<std::string>{"out.exr", "scene.pbrt"}));
}

TEST(Program, TimeLimitEndsARender) {
  const auto folder = folder_with_scene();
  const Result result = test::run_program(
      {"render", "scene.pbrt", "-o", "out.exr", "--spp", "16000000", "--time", "0.3"}, folder);
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_LT(std::stoi(read_exr(folder / "out.exr").metadata.at("caplet.samples_per_pixel")),
            16000000);
}

}  // namespace
}  // namespace caplet::program_test
