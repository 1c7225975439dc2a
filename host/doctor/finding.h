// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Findings of `caplet doctor`: one line each, and the solution of each problem.
#pragma once

#include <string>
#include <vector>

namespace caplet::doctor {

enum class State { ok, note, wrong };

struct Finding {
  State state = State::ok;
  std::string about;  // the subject: a file, a platform, a device
  std::string what;
  std::string fix;  // a command if possible; never empty for a problem
};

using Findings = std::vector<Finding>;

/// "ok", "note" or "wrong".
inline const char* name_of(State state) {
  return state == State::ok ? "ok" : state == State::note ? "note" : "wrong";
}

}  // namespace caplet::doctor
