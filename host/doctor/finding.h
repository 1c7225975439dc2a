// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// What `caplet doctor` found: one line each, and the fix for what is wrong.
#pragma once

#include <string>
#include <vector>

namespace caplet::doctor {

enum class State { ok, note, wrong };

struct Finding {
  State state = State::ok;
  std::string about;  // what was looked at: a file, a platform, a device
  std::string what;
  std::string fix;  // a command where there is one; never empty when something is wrong
};

using Findings = std::vector<Finding>;

/// "ok", "note" or "wrong".
inline const char* name_of(State state) { return state == State::ok ? "ok" : state == State::note ? "note" : "wrong"; }

}  // namespace caplet::doctor
