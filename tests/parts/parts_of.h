// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <cstddef>
#include <cstdlib>
#include <string>

namespace caplet::test {

/// While an instance exists, a buffer has so many bytes at most.
class PartsOf {
 public:
  explicit PartsOf(std::size_t bytes) {
    ::setenv("CAPLET_BUFFER_BYTES", std::to_string(bytes).c_str(), 1);
  }
  ~PartsOf() { ::unsetenv("CAPLET_BUFFER_BYTES"); }
  PartsOf(const PartsOf&) = delete;
  PartsOf& operator=(const PartsOf&) = delete;
};

// All tests have parts of one size, so that they share kernels; leaves need from two to four.
inline constexpr std::size_t part_bytes = 1310720;

}  // namespace caplet::test
