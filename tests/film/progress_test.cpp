// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The progress display: texts and how often it draws.
#include "base/progress.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace caplet {
namespace {

using testing::HasSubstr;
using testing::Not;
using namespace std::chrono_literals;

/// A reporter on a clock of our own.
struct Bench {
  ProgressReporter::Clock::time_point now{};
  std::vector<std::string> written;
  ProgressReporter reporter;
  explicit Bench(ProgressReporter::Style style)
      : reporter(
            style, [this](std::string_view text) { written.emplace_back(text); },
            [this] { return now; }) {}
};

TEST(Progress, Texts) {
  EXPECT_EQ(duration_text(0.42), "0.4 s");
  EXPECT_EQ(duration_text(59.4), "59 s");
  EXPECT_EQ(duration_text(187), "3:07");
  EXPECT_EQ(duration_text(5025), "1:23:45");
  EXPECT_EQ(rate_text(12.3e6), "12.30 Mpaths/s");
  EXPECT_EQ(rate_text(8100), "8.1 kpaths/s");
  EXPECT_EQ(time_left(0.25, 10).value(), 30);
  EXPECT_FALSE(time_left(0, 10).has_value());
}

TEST(Progress, BarFitsTheTerminal) {
  const ProgressState state{0.5, 10, 2e6, "32/64 samples"};
  for (int columns = 0; columns < 200; ++columns)
    EXPECT_LE(static_cast<int>(progress_bar(state, columns).size()), std::max(0, columns - 1))
        << columns;
  const std::string bar = progress_bar(state, 100);
  EXPECT_THAT(bar, HasSubstr("50 %"));
  EXPECT_THAT(bar, HasSubstr("2.00 Mpaths/s"));
  EXPECT_THAT(bar, HasSubstr("10 s left"));
  EXPECT_EQ(std::count(bar.begin(), bar.end(), '='), 20);
}

TEST(Progress, BarRedrawsFiveTimesASecond) {
  Bench bench(ProgressReporter::Style::bar);
  for (int i = 0; i < 1000; ++i) {
    bench.reporter.update(i / 1001.0, 1e6, "");
    bench.now += 1ms;
  }
  EXPECT_GE(bench.written.size(), 5u);
  EXPECT_LE(bench.written.size(), 6u);
  for (const std::string& text : bench.written) EXPECT_EQ(text.front(), '\r');
}

TEST(Progress, LinesAreFewAndPlain) {
  Bench bench(ProgressReporter::Style::lines);
  for (int i = 0; i < 1000; ++i) {
    bench.reporter.update(i / 1001.0, 1e6, "x");
    bench.now += 12ms;
  }
  bench.reporter.update(1, 1e6, "x");
  bench.reporter.update(1, 1e6, "x");
  ASSERT_EQ(bench.written.size(), 3u);
  for (const std::string& text : bench.written) {
    EXPECT_EQ(text.back(), '\n');
    EXPECT_THAT(text, Not(HasSubstr("\r")));
    EXPECT_THAT(text, Not(HasSubstr("\x1b")));
  }
  EXPECT_THAT(bench.written.back(), HasSubstr("100 %"));
}

TEST(Progress, ZeroStartsTheClock) {
  Bench bench(ProgressReporter::Style::lines);
  bench.now += 100s;  // compiling
  bench.reporter.update(0, 0, "");
  bench.now += 10s;
  bench.reporter.update(0.5, 1e6, "x");
  EXPECT_THAT(bench.written.back(), HasSubstr("10 s left"));
}

TEST(Progress, QuietIsQuiet) {
  Bench bench(ProgressReporter::Style::none);
  bench.reporter.update(0.5, 1, "");
  bench.reporter.update(1, 1, "");
  EXPECT_TRUE(bench.written.empty());
}

}  // namespace
}  // namespace caplet
