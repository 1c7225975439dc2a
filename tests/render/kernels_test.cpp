// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The stages' kernels and the buffers that they take.
#include "render/kernels.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <array>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <utility>

#include "support/test_device.h"

namespace caplet::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr std::pair<Stage, const char*> stages[] = {
#define STAGE(name, launch, is_used, groups) {Stage::name, #name},
#include "shared/queries.def"
#include "shared/stages.def"
#undef STAGE
};

// Stages of scenes with media carry what paths are within, and all that shading takes.
bool is_of_media(Stage stage) {
  return stage == Stage::camera_media || stage == Stage::recount_media ||
         stage == Stage::sample_distance || stage == Stage::shade_media ||
         stage == Stage::connect_media || stage == Stage::clip_media;
}

TEST(Kernels, TakeWhatTheyUse) {
  double sum = 0, count = 0;
  for (const auto& [stage, name] : stages) {
    std::printf("%s takes %zu buffers\n", name, buffer_count(stage));
    if (is_of_media(stage)) continue;
    sum += static_cast<double>(buffer_count(stage));
    ++count;
  }
  // Three of a tree's buffers are empty unless its leaves are divided.
  EXPECT_LE(sum / count, 18);
  EXPECT_LE(buffer_count(Stage::sample_distance), 71u);
  EXPECT_EQ(buffer_count(Stage::sort_prefix), 3u);  // the batch, keys and bins
}

std::string log_of(const Program& program, const char* kernel) {
  return program.kernel(kernel).getInfo<CL_KERNEL_PROGRAM>().getBuildInfo<CL_PROGRAM_BUILD_LOG>(
      test_device().handle());
}

// The driver's count of a kernel's arguments is the list's, and two: the number of items, and the
// counter of those there are.
TEST(Kernels, HaveTheArgumentsOfTheirGroups) {
  for (const auto& [stage, name] : stages) {
    const Program program =
        Program::from_source(test_device(), name, stage_source(stage), "-DCAPLET_REAL_WIDTH=1");
    EXPECT_EQ(program.kernel(name).getInfo<CL_KERNEL_NUM_ARGS>(), buffer_count(stage) + 2) << name;
    EXPECT_EQ(program.own_declarations(), test_device().is_pocl())
        << name << " calls what kernels/math/builtins.cl does not declare";
    if (test_device().is_pocl()) {
      EXPECT_THAT(log_of(program, name), Not(HasSubstr("warning")));
    }
  }
}

TEST(Kernels, OfAllLanesCallWhatIsDeclared) {
  for (const Stage stage : {Stage::extend, Stage::connect}) {
    const Program program =
        Program::from_source(test_device(), "lanes", stage_source(stage), "-DCAPLET_REAL_WIDTH=8");
    EXPECT_EQ(program.own_declarations(), test_device().is_pocl());
  }
}

TEST(Kernels, HaveTheOptionsThatTheyName) {
  EXPECT_EQ(options_of("#ifdef A_B\nx = C;", "-cl-x -DA_B -DA=1 -DC=2  -DC_D -DB"),
            "-cl-x -DA_B -DC=2");
  EXPECT_EQ(options_of("AB BA A", "-DA"), "-DA");
  EXPECT_EQ(options_of("AB BA", "-DA"), "");
  const std::string sky = "-DCAPLET_UNSEEN_SKY", tree = "-DCAPLET_LIGHT_TREE",
                    motion = "-DCAPLET_MOTION";
  const auto kept = [&](Stage stage) {
    return options_of(stage_source(stage), fmt::format("{} {} {}", sky, tree, motion));
  };
  EXPECT_EQ(kept(Stage::shade), fmt::format("{} {} {}", sky, tree, motion));
  EXPECT_EQ(kept(Stage::extend), motion);
  EXPECT_EQ(kept(Stage::connect_alpha), motion);
}

TEST(Kernels, WantTheBuffersOfTheirGroups) {
  Kernels kernels(test_device(), {"-DCAPLET_REAL_WIDTH=1", {}});
  EXPECT_THROW(kernels.run(Stage::sort_prefix, {}, 1), std::logic_error);  // not compiled
  kernels.compile(std::array{Stage::sort_prefix});
  EXPECT_THROW(kernels.run(Stage::sort_prefix, {}, 1), std::logic_error);  // no groups
}

}  // namespace
}  // namespace caplet::test
