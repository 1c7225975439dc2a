// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Errors quote a file only after part of it was valid in its format. A scene may name any file,
// such as those of other users that a service can read; errors in such files give the place without
// the text.
#pragma once

namespace caplet {

/// Marks the start of reading a file on this thread. Until prove() is called, may_quote is false,
/// and no text of the file is shown. If files include each other, the innermost one counts.
class Unproven {
 public:
  Unproven();
  ~Unproven();
  Unproven(const Unproven&) = delete;
  Unproven& operator=(const Unproven&) = delete;

  /// Part of the file was valid in its format.
  void prove() { is_proven_ = true; }
  bool is_proven() const { return is_proven_; }

 private:
  Unproven* outer_;
  bool is_proven_ = false;
};

/// Returns whether errors may show text of the file that this thread reads; text from no file may
/// always be shown.
bool may_quote();

/// This replaces text that may not be shown.
inline constexpr const char* withheld = "...";

}  // namespace caplet
