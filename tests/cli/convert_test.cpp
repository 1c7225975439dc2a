// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// `caplet convert`, as a user runs it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "film/image.h"
#include "program.h"
#include "support/data.h"

namespace caplet {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

void expect_same(const LayeredImage& a, const LayeredImage& b) {
  ASSERT_EQ(a.channels.size(), b.channels.size());
  for (const Channel& channel : a.channels) {
    EXPECT_EQ(channel.floats, b.find(channel.name)->floats) << channel.name;
    EXPECT_EQ(channel.uints, b.find(channel.name)->uints) << channel.name;
  }
}

TEST(Convert, WritesTextOfTheSamePicture) {
  const auto folder = test::folder_with_scene();
  const test::Result done = test::run_program({"convert", "scene.pbrt", "out.pbrt"}, folder);
  EXPECT_EQ(done.code, 0) << done.err;
  EXPECT_THAT(done.err, HasSubstr("wrote out.pbrt"));
  EXPECT_EQ(test::render(folder, {"-o", "a.exr"}).code, 0);
  EXPECT_EQ(test::run_program({"render", "out.pbrt", "-q", "-o", "b.exr"}, folder).code, 0);
  expect_same(read_exr(folder / "a.exr"), read_exr(folder / "b.exr"));
  const test::Result piped = test::run_program({"convert", "-q", "out.pbrt", "-"}, folder);
  EXPECT_EQ(piped.code, 0) << piped.err;
  EXPECT_EQ(piped.out, test::read_file(folder / "out.pbrt"));
}

TEST(Convert, TellsMachinesWhatItWrote) {
  const auto folder = test::folder_with_scene();
  const test::Result done =
      test::run_program({"convert", "scene.pbrt", "out.pbrt", "--json", "-q"}, folder);
  EXPECT_EQ(done.code, 0) << done.err;
  nlohmann::json told = nlohmann::json::parse(done.out);
  EXPECT_EQ(told.at("wrote"), "out.pbrt");
  told.erase("wrote");
  const test::Result info = test::run_program({"info", "scene.pbrt", "--json"}, folder);
  EXPECT_EQ(told, nlohmann::json::parse(info.out));
  const test::Result both = test::run_program({"convert", "scene.pbrt", "-", "--json"}, folder);
  EXPECT_EQ(both.code, 2);
  EXPECT_THAT(both.err, HasSubstr("--json: does not go with a scene on stdout"));
}

TEST(Convert, NeuronsKeepTheirFraming) {
  const auto folder = test::folder_with_scene();
  const std::string neuron = (test::source_folder() / "scenes/neuron.swc").string();
  EXPECT_EQ(test::run_program({"convert", neuron, "out.pbrt"}, folder).code, 0);
  for (const auto& [scene, picture] :
       {std::pair(neuron, "a.exr"), std::pair(std::string("out.pbrt"), "b.exr")})
    EXPECT_EQ(test::run_program(
                  {"render", scene, "-q", "--size", "40x60", "--spp", "2", "-o", picture}, folder)
                  .code,
              0);
  expect_same(read_exr(folder / "a.exr"), read_exr(folder / "b.exr"));
}

TEST(Convert, WhatIsWrongIsSaidAndNothingIsWritten) {
  const auto folder = test::folder_with_scene();
  const auto before = test::names_in(folder);
  const auto error_of = [&](const std::vector<std::string>& arguments, int code) {
    std::vector<std::string> all = {"convert"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    const test::Result result = test::run_program(all, folder);
    EXPECT_EQ(result.code, code) << result.err;
    return result.err;
  };
  EXPECT_THAT(error_of({"scene.pbrt"}, 2), HasSubstr("OUT.pbrt"));
  EXPECT_THAT(error_of({"scene.pbrt", "out.exr"}, 2), HasSubstr("pbrt text"));
  EXPECT_THAT(error_of({"none.pbrt", "out.pbrt"}, 2), HasSubstr("no such file"));
  EXPECT_THAT(error_of({"scene.pbrt", "no/out.pbrt"}, 2), StartsWith("caplet: error: OUT.pbrt: "));
  EXPECT_THAT(error_of({"scene.pbrt", "scene.pbrt"}, 2), HasSubstr("OUT.pbrt"));
  EXPECT_EQ(test::names_in(folder), before);
  EXPECT_EQ(test::read_file(folder / "scene.pbrt"), test::small_scene);
}

}  // namespace
}  // namespace caplet
