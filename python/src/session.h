// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <caplet/session.h>

#include <utility>

#include "binding.h"

namespace caplet_python {

/// A session, and whose turn it is: threads of Python wait for each other. The lock is taken without the interpreter's.
struct HeldSession {
  explicit HeldSession(caplet::Session of) : session(std::move(of)) {}
  caplet::Session session;
  std::mutex mutex;
};

}  // namespace caplet_python
