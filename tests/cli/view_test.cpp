// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// `caplet view` as one starts it: what it says of who sees the scene.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include "program.h"

namespace caplet {
namespace {

using test::Result;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

Result viewed(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), {"view", "scene.pbrt", "--no-browser"});
  test::Running running(arguments, test::folder_with_scene());
  EXPECT_TRUE(running.wait_for_stderr("is at the address above"));
  running.send(SIGINT);
  Result out = running.wait(60);
  EXPECT_EQ(out.code, 0) << out.err;
  return out;
}

TEST(View, IsForThisMachineAlone) {
  const Result result = viewed({});
  EXPECT_THAT(result.out, StartsWith("http://127.0.0.1:"));
  EXPECT_THAT(result.err, Not(HasSubstr("every machine")));
}

TEST(View, SaysToWhomItIsOpen) {
  const Result result = viewed({"--host", "0.0.0.0"});
  EXPECT_THAT(result.out, AllOf(StartsWith("http://"), Not(HasSubstr("0.0.0.0"))));
  const std::string authority = result.out.substr(7, result.out.find('/', 7) - 7);
  EXPECT_THAT(result.err,
              HasSubstr("--host 0.0.0.0: every machine that reaches this one at " + authority));
  EXPECT_THAT(result.err, AllOf(HasSubstr("change it, and save it"),
                                HasSubstr("nothing is encrypted"), HasSubstr("--read-only")));
  const Result looked = viewed({"--host", "0.0.0.0", "--read-only"});
  EXPECT_THAT(looked.err, AllOf(HasSubstr("every machine"), HasSubstr("can look at the scene;"),
                                Not(HasSubstr("change it"))));
}

TEST(View, RefusesScenesThatReachOutside) {
  const Result result = test::run_program(
      {"view", "scene.pbrt", "--no-browser", "--no-outside"},
      test::folder_with_scene("WorldBegin\nInclude \"/etc/passwd\"\nShape \"sphere\"\n"));
  EXPECT_EQ(result.code, 2);
  EXPECT_THAT(result.err,
              HasSubstr("scene.pbrt:2:9: '/etc/passwd' is outside of the scene's folder"));
}

}  // namespace
}  // namespace caplet
