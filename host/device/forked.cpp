// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "device/forked.h"

#include <pthread.h>

#include <atomic>

#include "base/error.h"

namespace caplet {

namespace {

std::atomic<bool> is_used{false}, is_forked{false};

void in_child() {
  if (is_used) is_forked = true;
}

// This runs before any thread can use OpenCL: a fork between a use and this would be missed.
[[maybe_unused]] const int registered = ::pthread_atfork(nullptr, nullptr, in_child);

}  // namespace

void begin_opencl() {
  if (is_forked)
    throw RunError(
        "this process was forked from one that had used OpenCL, which does not work in it: start "
        "processes by spawn "
        "(in Python: multiprocessing.set_start_method(\"spawn\")), or use no device before the "
        "fork");
  if (!is_used.load(std::memory_order_relaxed)) is_used = true;
}

bool forked_after_opencl() noexcept { return is_forked; }

}  // namespace caplet
