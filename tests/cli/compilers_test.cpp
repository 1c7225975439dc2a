// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The program compiles kernels in several processes of itself.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "pictures.h"
#include "program.h"
#include "support/data.h"

namespace caplet {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::ContainsRegex;
using testing::HasSubstr;
using testing::Not;

TEST(Compilers, ShareTheKernelsOfAFirstRender) {
  const fs::path folder = test::folder_with_scene(), cache = test::temporary_folder();
  const auto render = [&](const char* processes, const std::string& picture) {
    return test::run_program({"render", "scene.pbrt", "-o", picture, "--stats", "-"}, folder,
                             {{"POCL_CACHE_DIR", cache.string()},
                              {"CAPLET_CACHE", cache.string()},
                              {"CAPLET_SELF_TEST", "0"},
                              {"CAPLET_COMPILERS", processes}});
  };
  const test::Result first = render("3", "first.exr");
  ASSERT_EQ(first.code, 0) << first.err;
  EXPECT_THAT(first.err, ContainsRegex("compiling [0-9]+ kernels in 3 processes"));
  const auto seconds = nlohmann::json::parse(first.out).at("compile_seconds");
  for (const char* stage : {"generate", "extend_camera", "extend", "shade", "connect", "resolve"})
    EXPECT_LT(0, seconds.value(stage, 0.0)) << stage;
  const test::Result second = render("1", "second.exr");
  ASSERT_EQ(second.code, 0) << second.err;
  EXPECT_THAT(second.err, Not(HasSubstr("compiling")));
  test::expect_equal_pictures(folder / "first.exr", folder / "second.exr");
}

TEST(Compilers, WrongNumbersAreRefused) {
  const test::Result result =
      test::run_program({"render", "scene.pbrt", "-o", "a.exr"}, test::folder_with_scene(),
                        {{"CAPLET_COMPILERS", "many"}});
  EXPECT_EQ(result.code, 2);
  EXPECT_THAT(result.err,
              HasSubstr("CAPLET_COMPILERS: 'many' is not a number of processes, 1 to 64"));
}

TEST(Compilers, TheirCommandIsNotForPeople) {
  const test::Result result = test::run_program({"compile"}, test::temporary_folder());
  EXPECT_EQ(result.code, 2);
  EXPECT_THAT(result.err, HasSubstr("no list of jobs"));
}

}  // namespace
}  // namespace caplet
