// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The errors that the library throws, with their places.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include "caplet/export.h"

namespace caplet {

/// A place in the input. Lines and columns count from 1; 0: unknown. `file` may also name another
/// source of the error: an option or a device.
struct CAPLET_API SourceLocation {
  std::string file;
  int line = 0;
  int column = 0;

  /// Returns "file:line:column" without the unknown parts.
  std::string to_string() const;
};

/// Wrong input or usage. Each message is one line that contains its place.
class CAPLET_API InputError : public std::runtime_error {
 public:
  explicit InputError(const std::string& message);
  InputError(const SourceLocation& where, const std::string& message);
  explicit InputError(std::vector<std::string> messages);
  const std::vector<std::string>& messages() const { return messages_; }

 private:
  std::vector<std::string> messages_;
};

/// A failure of a device or a disk during work.
class CAPLET_API RunError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace caplet
