// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Work in a child process: what crashes or hangs there is told, not suffered.
#pragma once

#include <functional>
#include <string>

namespace caplet::doctor {

struct ChildEnd {
  bool finished = false;  // the work returned
  std::string answer;     // what it returned
  std::string how;        // else: "ended with signal 6 (Aborted)", "gave no answer in 20 s", the exception's message
  std::string said;       // the last line the child printed
  int exit_code = 0;      // if the child ended by one
};

/// Runs `work` in a child that has no terminal, for at most `seconds`. The child is gone when this returns, and dies with this
/// process. To be called before any thread is started and before any OpenCL call of this process, unless `work` does nothing but
/// exec. Ends early when `stop` says so.
ChildEnd in_child(const std::function<std::string()>& work, double seconds, const std::function<bool()>& stop = {});

}  // namespace caplet::doctor
