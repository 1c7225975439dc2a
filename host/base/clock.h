// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Monotonic time.
#pragma once

#include <chrono>
#include <utility>

namespace caplet {

using Clock = std::chrono::steady_clock;

/// Returns the seconds since `start`.
inline double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

class Stopwatch {
 public:
  /// Returns the seconds since the construction or the last lap.
  double lap() {
    const Clock::time_point now = Clock::now();
    return std::chrono::duration<double>(now - std::exchange(last_, now)).count();
  }

 private:
  Clock::time_point last_ = Clock::now();
};

}  // namespace caplet
