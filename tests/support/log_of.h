// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// What is logged while it lives.
#pragma once

#include <gtest/gtest.h>

#include <string>

namespace caplet::test {

class LogOf {
 public:
  LogOf() { testing::internal::CaptureStderr(); }
  ~LogOf() { take(); }
  LogOf(const LogOf&) = delete;
  LogOf& operator=(const LogOf&) = delete;

  /// All of it up to now.
  const std::string& text() {
    take();
    testing::internal::CaptureStderr();
    is_open_ = true;
    return text_;
  }

 private:
  void take() {
    if (is_open_) text_ += testing::internal::GetCapturedStderr();
    is_open_ = false;
  }
  std::string text_;
  bool is_open_ = true;
};

}  // namespace caplet::test
