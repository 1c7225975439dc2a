// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// `caplet verify`: verdicts and exit codes, reports, kept failures, and a device that computes
// wrongly.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "film/image.h"
#include "program.h"
#include "support/data.h"
#include "support/kinds.h"

namespace caplet::verify_test {
namespace {

namespace fs = std::filesystem;
using test::Result;
using testing::HasSubstr;
using testing::Not;

fs::path folder_with_scene() {
  return test::folder_with_scene(
      "LookAt 0 -8 3  0 0 0  0 0 1\nCamera \"perspective\" \"float fov\" 40\n"
      "Film \"rgb\" \"integer xresolution\" 32 \"integer yresolution\" 20\nWorldBegin\nLightSource "
      "\"infinite\"\n"
      "Shape \"sphere\" \"float radius\" 0.7\n"
      "Shape \"capsule\" \"point3 p0\" [-2 0 0] \"point3 p1\" [-1 1 1] \"float radius\" [0.5 0.2]\n"
      "Shape \"cylinder\" \"point3 p0\" [2 0 -1] \"point3 p1\" [2 0 1] \"float radius\" 0.5\n");
}

TEST(Verify, ASceneAgrees) {
  const Result result =
      test::run_program({"verify", "scene.pbrt", "--rays", "5000"}, folder_with_scene());
  EXPECT_EQ(result.code, 0) << result.out << result.err;
  for (const char* text :
       {"sphere", "tapered_capsule", "cylinder", "verdict    agrees: no disagreement in 5000 rays"})
    EXPECT_THAT(result.out, HasSubstr(text));
  EXPECT_THAT(result.out, Not(HasSubstr("polyhedron")));
}

TEST(Verify, ComputesOnAsManyThreadsAsAreAsked) {
  const Result result = test::run_program(
      {"verify", "scene.pbrt", "--rays", "100", "--json", "--threads", "1"}, folder_with_scene());
  ASSERT_EQ(result.code, 0) << result.err;
  const auto device = nlohmann::json::parse(result.out).at("devices").at(0);
  if (device.at("platform").get<std::string>().find("Portable") == std::string::npos)
    GTEST_SKIP() << "the driver is not PoCL";
  EXPECT_EQ(device.at("compute_units"), 1);
}

TEST(Verify, JsonOfTheTortureSet) {
  const Result result = test::run_program({"verify", "--rays", "8000", "--seed", "4", "--json"},
                                          test::temporary_folder());
  ASSERT_EQ(result.code, 0) << result.out << result.err;
  const auto json = nlohmann::json::parse(result.out);
  EXPECT_EQ(json.at("rays"), 8000);
  EXPECT_EQ(json.at("disagreements"), 0);
  EXPECT_GT(json.at("seconds").get<double>(), 0);
  EXPECT_EQ(json.at("verdict"), "agrees");
  EXPECT_EQ(json.at("kinds").size(), test::shape_kinds().size());
  for (const auto& [name, kind] : json.at("kinds").items()) {
    EXPECT_GT(kind.at("rays").get<int>(), 0) << name;
    EXPECT_GT(kind.at("hits").get<int>(), 0) << name;
    EXPECT_EQ(kind.at("disagreements"), 0) << name;
    EXPECT_LE(kind.at("worst").get<double>(), 1) << name;
    for (const char* quantity : {"t", "point", "normal", "uv"}) {
      EXPECT_LE(kind.at(quantity).at("bounds").at("median"),
                kind.at(quantity).at("bounds").at("worst"))
          << name;
      EXPECT_GE(kind.at(quantity).at("ulps").at("worst").get<double>(), 0) << name;
    }
  }
  EXPECT_EQ(json.at("devices").size(), 1u);
}

// A cylinder whose caps are half as far away, on a device that believes it.
TEST(Verify, AWrongDeviceIsFoundAndItsCasesReplayed) {
  const auto folder = folder_with_scene();
  const auto kernels = test::changed_kernels("shapes/sphere.cl", "sqrt(", "0.9f * sqrt(");
  const std::map<std::string, std::string> wrong = {{"CAPLET_KERNELS", kernels.string()}};
  const Result found = test::run_program(
      {"verify", "scene.pbrt", "--rays", "3000", "--save-failures", "cases", "--json"}, folder,
      wrong);
  EXPECT_EQ(found.code, 3) << found.err;
  const auto json = nlohmann::json::parse(found.out);
  EXPECT_EQ(json.at("verdict"), "disagrees");
  EXPECT_GT(json.at("disagreements").get<int>(), 100);
  EXPECT_GT(json.at("kinds").at("sphere").at("disagreements").get<int>(), 100);
  EXPECT_EQ(json.at("kinds").at("cylinder").at("disagreements"), 0);
  EXPECT_EQ(test::names_in(folder / "cases").size(), 100u);

  const Result again = test::run_program({"verify", "--replay", "cases"}, folder, wrong);
  EXPECT_EQ(again.code, 3) << again.err;
  EXPECT_THAT(again.out, HasSubstr("case-00001.json: DISAGREES"));
  EXPECT_THAT(again.out, HasSubstr("0 of 100 cases agree"));
  const Result mended = test::run_program({"verify", "--replay", "cases/case-00001.json"}, folder);
  EXPECT_EQ(mended.code, 0) << mended.err;
  EXPECT_THAT(mended.out, HasSubstr("1 of 1 cases agree"));
  const Result table = test::run_program({"verify", "scene.pbrt", "--rays", "3000"}, folder, wrong);
  EXPECT_EQ(table.code, 3);
  EXPECT_THAT(table.out, HasSubstr("verdict    DISAGREES"));
}

TEST(Verify, HeatmapOfTheScenesSize) {
  const auto folder = folder_with_scene();
  const Result result =
      test::run_program({"verify", "scene.pbrt", "--rays", "100", "--heatmap", "heat.exr"}, folder);
  ASSERT_EQ(result.code, 0) << result.err;
  const LayeredImage image = read_exr(folder / "heat.exr");
  EXPECT_EQ(image.data_width, 32);
  EXPECT_EQ(image.data_height, 20);
  for (const char* name : {"R", "G", "B", "t", "point", "normal", "uv", "grazing", "disagrees"})
    ASSERT_NE(image.find(name), nullptr) << name;
  float worst = 0, disagrees = 0;
  for (const float x : image.find("point")->floats) worst = std::max(worst, x);
  for (const float x : image.find("disagrees")->floats) disagrees = std::max(disagrees, x);
  EXPECT_GT(worst, 0);
  EXPECT_LE(worst, 1);
  EXPECT_EQ(disagrees, 0);
}

// PoCL shows one device for each name in POCL_DEVICES.
TEST(Verify, DeviceAgainstDevice) {
  const std::map<std::string, std::string> two = {{"POCL_DEVICES", "basic pthread"}};
  const auto folder = folder_with_scene();
  if (nlohmann::json::parse(test::run_program({"devices", "--json"}, folder, two).out).size() != 2)
    GTEST_SKIP() << "needs PoCL, with its devices 'basic' and 'pthread'";
  const Result result = test::run_program(
      {"verify", "scene.pbrt", "--rays", "2000", "--all-devices", "--json"}, folder, two);
  ASSERT_EQ(result.code, 0) << result.err;
  const auto json = nlohmann::json::parse(result.out);
  ASSERT_EQ(json.at("devices").size(), 2u);
  ASSERT_EQ(json.at("differences").size(), 1u);
  EXPECT_EQ(json.at("differences")[0].at("same"),
            2000);  // the same compiler for the same processor
  const Result text =
      test::run_program({"verify", "scene.pbrt", "--rays", "2000", "--all-devices"}, folder, two);
  for (const char* part : {"device against device", "0 and 1", "verdict 0", "verdict 1"})
    EXPECT_THAT(text.out, HasSubstr(part));
}

TEST(Verify, WrongUsage) {
  const auto folder = folder_with_scene();
  test::write_file(folder / "case-1.json", "{}");
  const auto refused = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "verify");
    const Result result = test::run_program(arguments, folder);
    EXPECT_EQ(result.code, 2) << result.err;
    EXPECT_EQ(result.out, "");
    return result.err;
  };
  EXPECT_THAT(refused({"missing.pbrt"}), HasSubstr("missing.pbrt"));
  EXPECT_THAT(refused({"--rays", "0"}), HasSubstr("--rays"));
  EXPECT_THAT(refused({"--rays", "-3"}), HasSubstr("--rays"));
  EXPECT_THAT(refused({"--device", "0", "--all-devices"}),
              HasSubstr("--device: does not go with --all-devices"));
  EXPECT_THAT(refused({"--device", "nothing like it"}), HasSubstr("nothing like it"));
  EXPECT_THAT(refused({"--heatmap", "heat.png"}), HasSubstr("--heatmap"));
  EXPECT_THAT(refused({"--heatmap", "no/such/folder/heat.exr"}), HasSubstr("--heatmap"));
  EXPECT_THAT(refused({"--size", "20x20"}), HasSubstr("--size: goes with --heatmap"));
  EXPECT_THAT(refused({"--heatmap", "heat.exr", "--size", "0x20"}), HasSubstr("--size"));
  EXPECT_THAT(refused({"--replay", "none.json"}), HasSubstr("none.json"));
  EXPECT_THAT(refused({"--replay", "case-1.json"}), HasSubstr("not a case"));
  EXPECT_THAT(refused({"scene.pbrt", "--replay", "case-1.json"}),
              HasSubstr("--replay: takes the scene from the cases"));
  EXPECT_THAT(refused({"--replay", "case-1.json", "--json"}), HasSubstr("--json"));
  EXPECT_THAT(refused({"--replay", "case-1.json", "--heatmap", "heat.exr"}),
              HasSubstr("--heatmap: does not go with --replay"));
  EXPECT_THAT(refused({"--replay", "case-1.json", "--save-failures", "cases"}),
              HasSubstr("--save-failures: does not go with --replay"));
  EXPECT_THAT(refused({"scene.pbrt", "scene.pbrt", "--save-failures", "cases"}),
              HasSubstr("--save-failures: keeps the name of one scene file"));
  EXPECT_EQ(test::names_in(folder), (std::vector<std::string>{"case-1.json", "scene.pbrt"}));
}

TEST(Verify, CtrlCSaysWhatWasAsked) {
  const auto folder = folder_with_scene();
  test::Running running({"verify", "scene.pbrt", "--rays", "1000000000", "--heatmap", "heat.exr"},
                        folder, {}, {}, test::Running::Stderr::terminal);
  ASSERT_TRUE(running.wait_for_stderr("Mrays/s"));
  running.send(SIGINT);
  const Result result = running.wait();
  EXPECT_EQ(result.code, 1) << result.err;
  EXPECT_THAT(result.err, HasSubstr("interrupted"));
  EXPECT_THAT(result.out, HasSubstr("interrupted"));
  EXPECT_EQ(test::names_in(folder), std::vector<std::string>{"scene.pbrt"});
}

}  // namespace
}  // namespace caplet::verify_test
