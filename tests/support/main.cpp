// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Runs the tests. A test fails that logged an error it did not declare (expect_logged_errors), or
// that left Caplet's environment variables changed for the tests after it.
#include <gtest/gtest.h>
#include <unistd.h>

#include <set>
#include <string>

#include "base/log.h"
#include "support/logged_errors.h"

namespace {

int allowed = 0;

class FailOnLoggedErrors : public testing::EmptyTestEventListener {
  void OnTestStart(const testing::TestInfo&) override {
    before_ = caplet::log::error_count();
    allowed = 0;
  }
  void OnTestEnd(const testing::TestInfo&) override {
    EXPECT_EQ(caplet::log::error_count() - before_, allowed)
        << "errors were logged that the test did not declare";
  }
  int before_ = 0;
};

class FailOnChangedVariables : public testing::EmptyTestEventListener {
  static std::set<std::string> variables() {
    std::set<std::string> out;
    for (char** one = environ; *one; ++one)
      if (const std::string text = *one; text.starts_with("CAPLET_")) out.insert(text);
    return out;
  }
  void OnTestStart(const testing::TestInfo&) override { before_ = variables(); }
  void OnTestEnd(const testing::TestInfo&) override {
    EXPECT_EQ(variables(), before_) << "the test did not set the environment back";
  }
  std::set<std::string> before_;
};

}  // namespace

void caplet::test::expect_logged_errors(int count) { allowed += count; }

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  testing::TestEventListeners& listeners = testing::UnitTest::GetInstance()->listeners();
  listeners.Append(new FailOnLoggedErrors);
  listeners.Append(new FailOnChangedVariables);
  return RUN_ALL_TESTS();
}
