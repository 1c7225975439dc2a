// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Errors with a place: what the library throws.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include "caplet/export.h"

namespace caplet {

/// Where something was said. Lines and columns count from 1; 0: unknown. `file` may also be what else was wrong: an option, a
/// device.
struct CAPLET_API SourceLocation {
  std::string file;
  int line = 0;
  int column = 0;

  /// "file:line:column", leaving out what is unknown.
  std::string to_string() const;
};

/// Wrong input or usage. One line per message, each already carrying its place.
class CAPLET_API InputError : public std::runtime_error {
 public:
  explicit InputError(const std::string& message);
  InputError(const SourceLocation& where, const std::string& message);
  explicit InputError(std::vector<std::string> messages);
  const std::vector<std::string>& messages() const { return messages_; }

 private:
  std::vector<std::string> messages_;
};

/// Failed while working (device, disk).
class CAPLET_API RunError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace caplet
