// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Signals, and a machine without a device.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <fstream>

#include "film/image.h"
#include "program.h"
#include "support/data.h"

namespace caplet::signals_test {
namespace {

namespace fs = std::filesystem;
using test::Result;
using testing::HasSubstr;
using testing::Not;

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

/// A scene that takes seconds to read, and is wrong at its end.
fs::path folder_with_long_scene() {
  std::string text, statements;
  for (int i = 0; i < 100000; ++i) statements += "Identity\n";
  for (int i = 0; i < 250; ++i) text += "Include \"statements.pbrt\"\n";
  const fs::path folder =
      test::folder_with_scene("Camera \"perspective\"\nWorldBegin\n" + text + "Nonsense\n");
  std::ofstream(folder / "statements.pbrt") << statements;
  return folder;
}

TEST(Signals, EndAtOnceWhileASceneIsRead) {
  const fs::path folder = folder_with_long_scene();
  const auto before = test::names_in(folder);
  const auto ended = [&](std::vector<std::string> arguments, int signal) {
    test::Running running(arguments, folder, {}, {}, test::Running::Stderr::terminal);
    EXPECT_TRUE(running.wait_for_stderr("reading scene.pbrt: 1 s"));
    running.send(signal);
    return running.wait();
  };
  const Result picture = ended({"render", "scene.pbrt", "-o", "out.exr"}, SIGINT);
  EXPECT_EQ(picture.code, 1) << picture.err;
  EXPECT_THAT(picture.err,
              HasSubstr("caplet: error: interrupted before anything was rendered; nothing is"));
  EXPECT_THAT(picture.err, Not(HasSubstr("Nonsense")));
  const Result film =
      ended({"render", "scene.pbrt", "-o", "out.exr", "--film", "f.caplet"}, SIGUSR1);
  EXPECT_EQ(film.code, 75) << film.err;
  EXPECT_THAT(film.err, HasSubstr("caplet: warning: interrupted before anything was rendered"));
  const Result tree = ended({"build", "scene.pbrt", "out.tree"}, SIGTERM);
  EXPECT_EQ(tree.code, 1) << tree.err;
  EXPECT_THAT(tree.err, HasSubstr("caplet: error: interrupted; nothing is written"));
  EXPECT_EQ(test::names_in(folder), before);
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
