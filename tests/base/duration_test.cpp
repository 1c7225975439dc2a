// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "base/duration.h"

#include <gtest/gtest.h>

namespace caplet {
namespace {

TEST(Durations, AreSumsOfUnits) {
  EXPECT_EQ(seconds_of("90"), 90);
  EXPECT_EQ(seconds_of("0.5"), 0.5);
  EXPECT_EQ(seconds_of("2e3"), 2000);
  EXPECT_EQ(seconds_of("90s"), 90);
  EXPECT_EQ(seconds_of("5m"), 300);
  EXPECT_EQ(seconds_of("1.5h"), 5400);
  EXPECT_EQ(seconds_of("1h30m"), 5400);
  EXPECT_EQ(seconds_of("1h2m3.5s"), 3723.5);
  EXPECT_EQ(seconds_of("1h5s"), 3605);
}

TEST(Durations, AreNothingElse) {
  for (const char* text : {"", "5x", "m", "5m5m", "3m1h", "1h30", "-1", "-1m", "0", "0s", "inf",
                           "nan", "1e400", "5 m", " 5", "5m ", "1d"})
    EXPECT_FALSE(seconds_of(text)) << text;
}

}  // namespace
}  // namespace caplet
