// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Work in a child process: answers, exceptions, signals, time limits.
#include "doctor/child.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>

namespace caplet::doctor {
namespace {

using testing::HasSubstr;

constexpr double plenty = 100;  // seconds

class InChild : public testing::Test {
 protected:
  ~InChild() override {
    EXPECT_EQ(::waitpid(-1, nullptr, WNOHANG), -1) << "a child was left";
    EXPECT_EQ(errno, ECHILD);
  }
};

TEST_F(InChild, AnswersOfAnyLengthComeBack) {
  const std::string long_answer(1000000, 'x');
  const ChildEnd end = in_child([&] { return long_answer; }, plenty);
  EXPECT_TRUE(end.finished) << end.how;
  EXPECT_EQ(end.answer, long_answer);
}

TEST_F(InChild, WhatItPrintsIsKeptFromTheTerminal) {
  const ChildEnd end = in_child(
      [] {
        std::fputs("first\nlast\n", stderr);
        return std::string("answer");
      },
      plenty);
  EXPECT_EQ(end.answer, "answer");
  EXPECT_EQ(end.said, "last");
}

TEST_F(InChild, ExceptionsAreTold) {
  const ChildEnd end =
      in_child([]() -> std::string { throw std::runtime_error("no good"); }, plenty);
  EXPECT_FALSE(end.finished);
  EXPECT_EQ(end.how, "no good");
}

TEST_F(InChild, CrashesAreTold) {
  const ChildEnd end = in_child([]() -> std::string { std::abort(); }, plenty);
  EXPECT_FALSE(end.finished);
  EXPECT_THAT(end.how, HasSubstr("signal 6"));
  const ChildEnd leaves = in_child([]() -> std::string { ::_exit(3); }, plenty);
  EXPECT_FALSE(leaves.finished);
  EXPECT_THAT(leaves.how, HasSubstr("exit code 3"));
}

TEST_F(InChild, HangingEndsAtTheLimit) {
  const auto start = std::chrono::steady_clock::now();
  const ChildEnd end = in_child(
      []() -> std::string {
        ::fork();  // both hang
        for (;;) ::pause();
      },
      0.2);
  EXPECT_FALSE(end.finished);
  EXPECT_THAT(end.how, HasSubstr("no answer in 0.2 s"));
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(60));
}

}  // namespace
}  // namespace caplet::doctor
