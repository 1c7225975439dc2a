// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Runs the tests; a test that logged an error it did not declare (expect_logged_errors) fails.
#include <gtest/gtest.h>

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

}  // namespace

void caplet::test::expect_logged_errors(int count) { allowed += count; }

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  testing::UnitTest::GetInstance()->listeners().Append(new FailOnLoggedErrors);
  return RUN_ALL_TESTS();
}
