// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Errors with a place. Exceptions inside, one catch per door (host/cli).
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

namespace caplet {

/// Where something was said. Lines and columns count from 1; 0: unknown. `file` may also be a flag ("--size") or a device.
struct SourceLocation {
  std::string file;
  int line = 0;
  int column = 0;

  /// "file:line:column", leaving out what is unknown.
  std::string to_string() const;
};

/// Wrong input or usage: exit code 2. One line per message, each already carrying its place.
class InputError : public std::runtime_error {
 public:
  explicit InputError(const std::string& message);
  InputError(const SourceLocation& where, const std::string& message);
  explicit InputError(std::vector<std::string> messages);
  const std::vector<std::string>& messages() const { return messages_; }

 private:
  std::vector<std::string> messages_;
};

/// Failed while working (device, disk): exit code 1.
class RunError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

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
