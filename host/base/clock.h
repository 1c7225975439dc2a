// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Time that only goes forward.
#pragma once

#include <chrono>
#include <utility>

namespace caplet {

using Clock = std::chrono::steady_clock;

/// Seconds of the wall clock since `start`.
inline double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

class Stopwatch {
 public:
  /// Seconds since the construction or the last lap.
  double lap() {
    const Clock::time_point now = Clock::now();
    return std::chrono::duration<double>(now - std::exchange(last_, now)).count();
  }

 private:
  Clock::time_point last_ = Clock::now();
};

}  // namespace caplet
