// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "base/log.h"

#include <atomic>
#include <cstdio>
#include <mutex>
#include <string>

#include "base/status_line.h"
#include "base/utf8.h"

namespace caplet {

namespace {

std::atomic<int> errors{0};
std::atomic<LogLevel> least{LogLevel::warning};
std::mutex writing;
std::string shown_line;  // the terminal's last line; guarded by `writing`

void print(std::string_view text) {
  std::fwrite(text.data(), 1, text.size(), stderr);
  std::fflush(stderr);
}

/// The sink is never destroyed, because destructors at the end of the process may still log.
LogSink& sink() {
  static auto* set = new LogSink;
  return *set;
}

const char* name_of(LogLevel level) {
  return level == LogLevel::error ? "error" : level == LogLevel::warning ? "warning" : "info";
}

}  // namespace

void set_log_sink(LogSink to) {
  const std::lock_guard lock(writing);
  sink() = std::move(to);
}

void set_log_level(LogLevel level) { least = level; }

namespace log {

int error_count() { return errors; }
bool is_shown(LogLevel level) { return level >= least; }

void write(LogLevel level, std::string_view message) {
  if (level == LogLevel::error) ++errors;
  if (!is_shown(level)) return;
  const std::lock_guard lock(writing);
  if (sink()) return sink()(level, message);
  const char* const clear = shown_line.empty() ? "" : "\r\x1b[K";
  print(fmt::format("{}caplet: {}: {}\n{}", clear, name_of(level), one_line(message), shown_line));
}

void show_line(std::string_view text) {
  const std::lock_guard lock(writing);
  if (!text.empty() || !shown_line.empty()) print(fmt::format("\r{}\x1b[K", text));
  shown_line = text;
}

}  // namespace log

}  // namespace caplet
