// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Diagnostics, one line each, on stderr unless a sink is set (caplet/log.h). Results are never
// logged.
#pragma once

#include <fmt/format.h>

#include <string_view>
#include <utility>

#include "caplet/log.h"

namespace caplet::log {

/// Shows only warnings and errors, or also `info`.
inline void set_quiet(bool quiet) { set_log_level(quiet ? LogLevel::warning : LogLevel::info); }
/// Returns the number of errors logged since the start; tests fail when it changes unexpectedly.
int error_count();

bool is_shown(LogLevel level);
void write(LogLevel level, std::string_view message);

template <class... Values>
void info(fmt::format_string<Values...> text, Values&&... values) {
  if (is_shown(LogLevel::info))
    write(LogLevel::info, fmt::format(text, std::forward<Values>(values)...));
}
template <class... Values>
void warn(fmt::format_string<Values...> text, Values&&... values) {
  if (is_shown(LogLevel::warning))
    write(LogLevel::warning, fmt::format(text, std::forward<Values>(values)...));
}
/// Errors are counted whether they are shown or not.
template <class... Values>
void error(fmt::format_string<Values...> text, Values&&... values) {
  write(LogLevel::error, fmt::format(text, std::forward<Values>(values)...));
}

}  // namespace caplet::log
