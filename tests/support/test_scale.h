// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// How long comparisons of random cases run: CAPLET_TEST_SCALE=N in the environment makes them N
// times as long.
#pragma once

#include <algorithm>
#include <cstdlib>

namespace caplet::test {

/// CAPLET_TEST_SCALE, 1 to 1000; 1 when it is not set.
inline int test_scale() {
  const char* text = std::getenv("CAPLET_TEST_SCALE");
  return text ? std::clamp(std::atoi(text), 1, 1000) : 1;
}

}  // namespace caplet::test
