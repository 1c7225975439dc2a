// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// These tests are of wrong command lines, help by name and times with units.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <vector>

#include "program.h"

namespace caplet {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

class Usage : public testing::Test {
 protected:
  test::Result run(const std::vector<std::string>& arguments) const {
    return test::run_program(arguments, folder_);
  }
  void refused(const std::vector<std::string>& arguments, const std::string& message) const {
    const test::Result result = run(arguments);
    EXPECT_EQ(result.code, 2) << testing::PrintToString(arguments);
    EXPECT_THAT(result.err, StartsWith("caplet: error: " + message + "\n"));
    EXPECT_EQ(result.out, "");
  }
  const std::filesystem::path folder_ = test::folder_with_scene();
};

TEST_F(Usage, UnknownThingsAreNamedWithTheNearest) {
  refused({"rendr", "scene.pbrt"}, "unknown command 'rendr'; the nearest is 'render'");
  refused({"--bogus", "render", "scene.pbrt"}, "unknown option '--bogus'; the nearest is '--help'");
  refused({"--verson"}, "unknown option '--verson'; the nearest is '--version'");
  refused({"render", "scene.pbrt", "--noize", "3%"},
          "unknown option '--noize'; the nearest is '--noise'");
  refused({"render", "scene.pbrt", "--sise=64x64"},
          "unknown option '--sise'; the nearest is '--size'");
  // This tells more than that SCENE is missing.
  refused({"render", "--denoize"}, "unknown option '--denoize'; the nearest is '--denoise'");
  refused({"render"}, "SCENE is required");
  refused({"devices", "all"}, "devices: unexpected argument 'all'");
  refused({"help", "pik"}, "help: there is no command 'pik'; the nearest is 'pick'");
}

TEST_F(Usage, MissingValuesAreNamed) {
  refused({"render", "scene.pbrt", "--size"}, "--size: its value WxH is missing");
  refused({"render", "scene.pbrt", "--turntable"}, "--turntable: its value N is missing");
}

TEST_F(Usage, MisspeltValuesAreToldTheNearest) {
  std::ofstream(folder_ / "a.xyz") << "1\n\nC 0 0 0\n";
  for (const auto& [option, message] :
       {std::pair("--style=stiks",
                  "--style: 'stiks' is none of: ball-and-stick, spheres, sticks, "
                  "trace, cartoon, surface, accessible; the nearest is 'sticks'"),
        std::pair("--color=chian",
                  "--color: 'chian' is none of: element, chain, residue, bfactor, "
                  "secondary, charge, distance from ATOMS; the nearest is 'chain'")})
    EXPECT_THAT(run({"render", "a.xyz", option}).err,
                StartsWith(std::string("caplet: error: ") + message + "\n"));
}

TEST_F(Usage, HelpIsThatOfTheOption) {
  const test::Result all = run({"help"});
  EXPECT_EQ(all.code, 0);
  EXPECT_THAT(all.out, HasSubstr("\n  render "));
  EXPECT_EQ(all.out, run({"--help"}).out);
  EXPECT_EQ(run({"help", "pick"}).out, run({"pick", "--help"}).out);
  EXPECT_THAT(run({"help", "pick"}).out, HasSubstr("--pixel"));
}

TEST_F(Usage, TimesHaveUnits) {
  refused({"render", "scene.pbrt", "--time=5x"},
          "--time: '5x' is not a positive time, such as 90, 5m or 1h30m");
  refused({"render", "scene.pbrt", "--checkpoint=0.01"},
          "--checkpoint: '0.01' is less than 0.1 seconds");
  for (const char* time : {"60", "1.5m", "1m30s", "1e-9h", "0.5s"})
    EXPECT_EQ(run({"render", "scene.pbrt", "-q", "-o", "out.exr", "--time", time}).code, 0) << time;
  // A millionth of an hour is 3.6 ms, of which a render of a million samples does few.
  const test::Result cut =
      run({"render", "scene.pbrt", "-o", "out.exr", "--spp", "1000000", "--time", "1e-6h"});
  EXPECT_EQ(cut.code, 0) << cut.err;
}

}  // namespace
}  // namespace caplet
