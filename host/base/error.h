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

/// Collects input errors so that several are reported at once; throws InputError when `limit` is reached and at `finish`.
class Diagnostics {
 public:
  explicit Diagnostics(std::size_t limit = 20) : limit_(limit) {}
  void error(const SourceLocation& where, const std::string& message);
  void warning(const SourceLocation& where, const std::string& message);  // logged at once
  bool has_errors() const { return !errors_.empty(); }
  /// Throws InputError with all errors, if there are any.
  void finish() const;

 private:
  std::size_t limit_;
  std::vector<std::string> errors_;
};

namespace detail {
[[noreturn]] void check_failed(const char* expression, const std::string& a, const std::string& b, const char* file, int line);
}

}  // namespace caplet
