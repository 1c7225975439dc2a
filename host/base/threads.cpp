// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "base/threads.h"

#include <algorithm>
#include <atomic>
#include <thread>

namespace caplet {

namespace {

std::atomic<unsigned> limit = 0;

}  // namespace

void limit_threads(unsigned most) { limit = std::max(1U, most); }

unsigned thread_limit() { return limit; }

unsigned usable_threads() {
  const unsigned processors = std::max(1U, std::thread::hardware_concurrency());
  return limit == 0 ? processors : std::min<unsigned>(limit, processors);
}

}  // namespace caplet
