// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Errors with a place (caplet/error.h), and a collection of them. Each interface (host/cli) catches
// the exceptions once.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "caplet/error.h"

namespace caplet {

/// Collects input errors so that several are reported at once. Errors of one kind share a line,
/// that of the first, with the number of the others. Beyond `limit` lines only the number of errors
/// is reported.
class Diagnostics {
 public:
  /// `error` throws at so many errors, because reading on is useless.
  static constexpr std::size_t most_errors = 100'000;

  explicit Diagnostics(std::size_t limit = 20) : limit_(limit) {}
  /// `kind` groups errors, such as an unsupported feature; if it is empty, the error has its own
  /// line. Throws InputError with all errors when there are `most_errors`.
  void error(const SourceLocation& where, const std::string& message, const std::string& kind = {});
  /// Counts errors without messages.
  void add_more(std::size_t count);
  void warning(const SourceLocation& where, const std::string& message);  // logged at once
  bool has_errors() const { return count_ > 0; }
  std::size_t error_count() const { return count_; }
  /// Returns true when no further line will be shown, so that its text need not be made.
  bool is_full() const { return lines_.size() >= limit_; }
  /// Throws InputError with all errors, if there are any.
  void finish() const;

 private:
  struct Line {
    std::string text, kind;
    std::size_t others = 0;  // further errors of its kind
  };
  std::size_t limit_;
  std::vector<Line> lines_;
  std::size_t count_ = 0, beyond_ = 0;  // beyond_: those without a line
  bool stopped_ = false;
};

namespace detail {
[[noreturn]] void check_failed(const char* expression, const std::string& a, const std::string& b,
                               const char* file, int line);
}

}  // namespace caplet
