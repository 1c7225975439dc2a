// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Errors quote a file only after it has shown itself to be of its format. A scene may name other files, such as those of other
// users that a service may read; of these, errors name the place and show nothing.
#pragma once

namespace caplet {

/// Made where this thread begins to read a file. Until prove() is called, what the file holds is shown nowhere: may_quote is
/// false. Where files name each other the innermost counts.
class Unproven {
 public:
  Unproven();
  ~Unproven();
  Unproven(const Unproven&) = delete;
  Unproven& operator=(const Unproven&) = delete;

  /// Something in it could be read as its format has it.
  void prove() { is_proven_ = true; }
  bool is_proven() const { return is_proven_; }

 private:
  Unproven* outer_;
  bool is_proven_ = false;
};

/// Whether words of the file that this thread reads may be shown. Of what no file holds they may.
bool may_quote();

/// Stands for words that may not.
inline constexpr const char* withheld = "...";

}  // namespace caplet
