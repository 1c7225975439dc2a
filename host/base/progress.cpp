// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "base/progress.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <utility>

#include "base/status_line.h"
#include "base/utf8.h"

namespace caplet {

namespace {

int terminal_columns() {
  winsize size{};
  if (::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0) return size.ws_col;
  return 80;
}

void write_stderr(std::string_view text) {
  std::fwrite(text.data(), 1, text.size(), stderr);
  std::fflush(stderr);
}

std::string tail_text(const ProgressState& state) {
  std::string out = state.detail;
  const auto add = [&](const std::string& text) { out += (out.empty() ? "" : ", ") + text; };
  if (state.paths_per_second > 0) add(rate_text(state.paths_per_second));
  if (state.fraction >= 1)
    add("took " + duration_text(state.seconds));
  else if (const auto left = time_left(state.fraction, state.seconds))
    add(duration_text(*left) + " left");
  return out;
}

double percent(double fraction) { return std::floor(100 * std::clamp(fraction, 0.0, 1.0)); }

}  // namespace

std::string duration_text(double seconds) {
  if (!(seconds >= 0)) return "?";
  if (seconds < 9.95) return fmt::format("{:.1f} s", seconds);
  const long long whole = std::llround(std::min(seconds, 1e15));
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{}:{:02}", whole / 60, whole % 60);
  return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
}

std::string rate_text(double paths_per_second) {
  if (paths_per_second >= 1e6) return fmt::format("{:.2f} Mpaths/s", paths_per_second * 1e-6);
  if (paths_per_second >= 1e3) return fmt::format("{:.1f} kpaths/s", paths_per_second * 1e-3);
  return fmt::format("{:.0f} paths/s", paths_per_second);
}

std::optional<double> time_left(double fraction, double seconds) {
  if (!(fraction >= 1e-3)) return std::nullopt;
  return std::max(0.0, seconds * (1 - fraction) / fraction);
}

std::string progress_bar(const ProgressState& state, int columns) {
  const std::string tail = fmt::format("{:3.0f} %  {}", percent(state.fraction), tail_text(state));
  const int room = columns - 1 - static_cast<int>(tail.size()) - 3;
  if (room < 4) return tail.substr(0, static_cast<std::size_t>(std::max(0, columns - 1)));
  const int cells = std::min(room, 40);
  const int full = static_cast<int>(std::floor(cells * std::clamp(state.fraction, 0.0, 1.0)));
  return fmt::format("[{}{}] {}", std::string(static_cast<std::size_t>(full), '='),
                     std::string(static_cast<std::size_t>(cells - full), ' '), tail);
}

std::string progress_line(const ProgressState& state) {
  return fmt::format("caplet: {:.0f} %, {}", percent(state.fraction), tail_text(state));
}

ProgressReporter::Style ProgressReporter::style_for_stderr(bool quiet) {
  if (quiet) return Style::none;
  const char* terminal = std::getenv("TERM");
  const bool dumb = terminal && std::string_view(terminal) == "dumb";
  return ::isatty(STDERR_FILENO) && !dumb ? Style::bar : Style::lines;
}

ProgressReporter::ProgressReporter(Style style, std::function<void(std::string_view)> write,
                                   std::function<Clock::time_point()> now)
    : style_(style),
      write_(write ? std::move(write) : write_stderr),
      now_(std::move(now)),
      start_(now_()) {}

ProgressReporter::~ProgressReporter() { clear_bar(); }

void ProgressReporter::clear_bar() {
  if (bar_shown_) write_("\r\x1b[K");
  bar_shown_ = false;
}

void ProgressReporter::update(double fraction, double paths_per_second, const std::string& detail) {
  if (style_ == Style::none || finished_) return;
  const Clock::time_point now = now_();
  if (!(fraction > 0)) start_ = now;
  const ProgressState state{fraction, std::chrono::duration<double>(now - start_).count(),
                            paths_per_second, detail};
  if (fraction >= 1) {
    finished_ = true;
    clear_bar();
    write_(progress_line(state) + "\n");
    return;
  }
  // Lines count their interval from the start, so that short tasks print only the end.
  const double interval = style_ == Style::bar ? 0.2 : 5.0;
  const Clock::time_point last =
      drawn_ ? *drawn_ : (style_ == Style::bar ? now - std::chrono::hours(1) : start_);
  if (std::chrono::duration<double>(now - last).count() < interval) return;
  drawn_ = now;
  if (style_ == Style::lines) {
    write_(progress_line(state) + "\n");
    return;
  }
  bar_shown_ = true;
  write_("\r" + progress_bar(state, terminal_columns()) + "\x1b[K");
}

StepNotice::StepNotice(std::string what, ProgressReporter::Style style) {
  if (style != ProgressReporter::Style::bar) return;
  thread_ = std::thread([this, what = std::move(what)] { run(what); });
}

StepNotice::~StepNotice() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    ended_ = true;
  }
  changed_.notify_one();
  thread_.join();
}

void StepNotice::run(const std::string& what) {
  using namespace std::chrono_literals;
  const auto start = std::chrono::steady_clock::now();
  // The line must not wrap: only its last row could be cleared.
  constexpr int around = 24;  // the most characters before and behind `what`
  const auto most = static_cast<std::size_t>(std::max(terminal_columns() - around, 0));
  const std::string shown = one_line(std::string_view(what).substr(0, most));
  std::unique_lock lock(mutex_);
  for (int seconds = 1; !changed_.wait_until(lock, start + seconds * 1s, [this] { return ended_; });
       ++seconds)
    log::show_line(fmt::format("caplet: {}: {} s", shown, seconds));
  log::show_line("");
}

}  // namespace caplet
