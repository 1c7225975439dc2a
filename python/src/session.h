// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <caplet/session.h>

#include <utility>

#include "binding.h"

namespace caplet_python {

/// A session, and whose turn it is: threads of Python wait for each other. Both are used without
/// the interpreter's lock.
struct HeldSession {
  explicit HeldSession(caplet::Session of) : session(std::move(of)) {}
  caplet::Session session;
  Lock lock;
};

/// Its turn, of a session or a picker. Throws RunError where this process was forked, before it
/// waits.
template <class Owner>
std::unique_lock<Lock> turn_of(Owner& held) {
  caplet::check_process();
  return std::unique_lock(held.lock);
}

}  // namespace caplet_python
