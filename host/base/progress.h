// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Reports the progress of a long task on stderr: a bar on a terminal, plain lines elsewhere.
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <thread>

namespace caplet {

struct ProgressState {
  double fraction = 0;          // 0..1
  double seconds = 0;           // since the start
  double paths_per_second = 0;  // 0: unknown
  std::string detail;           // "12/64 samples"
};

/// Returns "1:23:45", "3:07" or "0.4 s".
std::string duration_text(double seconds);
/// Returns "12.3 Mpaths/s", "8.1 kpaths/s".
std::string rate_text(double paths_per_second);
/// Returns the seconds left at the present speed; no value before 0.1 % is done.
std::optional<double> time_left(double fraction, double seconds);

/// Returns one line without line break, of at most `columns` characters: bar, percent, detail,
/// rate, time left.
std::string progress_bar(const ProgressState& state, int columns);
/// Returns the same in words.
std::string progress_line(const ProgressState& state);

class ProgressReporter {
 public:
  enum class Style { none, lines, bar };
  using Clock = std::chrono::steady_clock;

  /// Chooses a bar on a terminal, lines otherwise, and nothing when quiet.
  static Style style_for_stderr(bool quiet);

  /// Writes to stderr when `write` is empty. `now` is for tests.
  explicit ProgressReporter(Style style, std::function<void(std::string_view)> write = {},
                            std::function<Clock::time_point()> now = Clock::now);
  /// Clears the bar.
  ~ProgressReporter();
  ProgressReporter(const ProgressReporter&) = delete;
  ProgressReporter& operator=(const ProgressReporter&) = delete;

  /// Draws when the last drawing is 0.2 s (bar) or 5 s (lines) old; the end of the task is always
  /// drawn as a line. A fraction of 0 restarts the clock, so that earlier work does not count.
  void update(double fraction, double paths_per_second, const std::string& detail);

 private:
  void clear_bar();

  Style style_;
  std::function<void(std::string_view)> write_;
  std::function<Clock::time_point()> now_;
  Clock::time_point start_;
  std::optional<Clock::time_point> drawn_;
  bool bar_shown_ = false, finished_ = false;
};

/// While an instance exists, a line on the terminal says what takes so long and counts the seconds,
/// from the second one on. For steps that do not know how far they are; they may write messages
/// meanwhile.
class StepNotice {
 public:
  /// Shows nothing unless `style` is a bar.
  StepNotice(std::string what, ProgressReporter::Style style);
  /// Clears the line.
  ~StepNotice();
  StepNotice(const StepNotice&) = delete;
  StepNotice& operator=(const StepNotice&) = delete;

 private:
  void run(const std::string& what);
  std::mutex mutex_;
  std::condition_variable changed_;
  bool ended_ = false;
  std::thread thread_;
};

}  // namespace caplet
