// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Runs work in a child process, so that a crash or a hang there is reported.
#pragma once

#include <functional>
#include <string>

namespace caplet::doctor {

struct ChildEnd {
  bool finished = false;  // the work returned
  std::string answer;     // what it returned
  std::string how;        // else: "ended with signal 6 (Aborted)", "gave no answer in 20 s", the
                          // exception's message
  std::string said;       // the last line the child printed
  int exit_code = 0;      // if the child ended by one
};

/// Runs `work` in a child without a terminal for at most `seconds`. The child has ended when this
/// returns, and dies with this process. It must be called before this process starts a thread or
/// calls OpenCL, unless `work` only calls exec. Ends early when `stop` returns true.
ChildEnd in_child(const std::function<std::string()>& work, double seconds,
                  const std::function<bool()>& stop = {});

}  // namespace caplet::doctor
