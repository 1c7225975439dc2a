// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Errors with a place (caplet/error.h), and a collection of them. Exceptions inside, one catch per door (host/cli).
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "caplet/error.h"

namespace caplet {

/// Collects input errors so that several are reported at once. Errors of one kind are one line, the first, with the number of the
/// others; of what goes beyond `limit` lines only the number is said.
class Diagnostics {
 public:
  /// With so many errors there is no use in reading on: `error` throws.
  static constexpr std::size_t most_errors = 100'000;

  explicit Diagnostics(std::size_t limit = 20) : limit_(limit) {}
  /// `kind` is what groups errors, such as a feature that is not rendered yet; empty: the error has a line of its own. Throws
  /// InputError with all errors when they are `most_errors`.
  void error(const SourceLocation& where, const std::string& message, const std::string& kind = {});
  /// Counts errors whose messages were never made.
  void add_more(std::size_t count);
  void warning(const SourceLocation& where, const std::string& message);  // logged at once
  bool has_errors() const { return count_ > 0; }
  std::size_t error_count() const { return count_; }
  /// True when no further line will be shown, so that no work need go into its text.
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
  std::size_t count_ = 0, beyond_ = 0;  // beyond_: those that are in no line
  bool stopped_ = false;
};

namespace detail {
[[noreturn]] void check_failed(const char* expression, const std::string& a, const std::string& b, const char* file, int line);
}

}  // namespace caplet
