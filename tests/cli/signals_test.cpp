// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Signals, and a machine without a device.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include "film/image.h"
#include "program.h"
#include "support/data.h"

namespace caplet::signals_test {
namespace {

namespace fs = std::filesystem;
using test::Result;
using testing::HasSubstr;

constexpr const char* endless = "16000000";  // samples

class Signals : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(All, Signals, testing::Values(SIGINT, SIGTERM, SIGHUP),
                         [](const auto& number) {
                           return std::string(::sigabbrev_np(number.param));
                         });

TEST_P(Signals, WriteTheFinishedPasses) {
  const fs::path folder = test::folder_with_scene();
  test::Running running({"render", "scene.pbrt", "-o", "out.exr", "--spp", endless}, folder, {}, {},
                        test::Running::Stderr::terminal);
  ASSERT_TRUE(running.wait_for_stderr("paths/s"));
  running.send(GetParam());
  if (GetParam() == SIGHUP) running.send(SIGHUP);  // as when a terminal and its shell go
  const Result result = running.wait();
  ASSERT_EQ(result.code, 0) << result.err << " signal " << result.signal;
  EXPECT_THAT(result.err, HasSubstr("interrupted"));
  EXPECT_EQ(read_exr(folder / "out.exr").metadata.at("caplet.interrupted"), "yes");
}

TEST(Signals, NohupIsHeard) {
  const fs::path folder = test::folder_with_scene();
  test::Running running(
      {"render", "scene.pbrt", "-o", "out.exr", "--spp", endless, "--time", "3"}, folder, {},
      [] { ::signal(SIGHUP, SIG_IGN); }, test::Running::Stderr::terminal);
  ASSERT_TRUE(running.wait_for_stderr("paths/s"));
  running.send(SIGHUP);
  ASSERT_EQ(running.wait().code, 0);
  EXPECT_EQ(read_exr(folder / "out.exr").metadata.at("caplet.interrupted"), "no");
}

TEST(Signals, TheSecondEndsAtOnce) {
  const fs::path folder = test::folder_with_scene();
  // One pass of many pixels, so that the first signal cannot end the program before the second
  // comes.
  test::Running running(
      {"render", "scene.pbrt", "-o", "out.exr", "--spp", endless, "--size", "2048x2048"}, folder);
  ASSERT_TRUE(running.wait_for_stderr("samples per pixel on"));
  running.send(SIGINT);
  running.send(SIGTERM);
  const Result result = running.wait(60);
  EXPECT_TRUE(result.signal == SIGINT || result.signal == SIGTERM) << result.code << result.err;
  EXPECT_EQ(test::names_in(folder), std::vector<std::string>{"scene.pbrt"});
}

TEST(NoDevice, IsAFailureNotAUsageError) {
  const fs::path folder = test::folder_with_scene();
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"render", "scene.pbrt"},
        {"pick", "scene.pbrt", "--pixel", "1,1"},
        {"verify", "--rays", "10"}}) {
    const Result result = test::run_program(
        arguments, folder,
        {{"OCL_ICD_VENDORS", "/nonexistent"}, {"OPENCL_VENDOR_PATH", "/nonexistent"}});
    EXPECT_EQ(result.code, 1) << arguments[0];
    EXPECT_THAT(result.err, HasSubstr("caplet: error: --device: no OpenCL device was found"))
        << arguments[0];
  }
}

}  // namespace
}  // namespace caplet::signals_test
