// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <cstdint>

namespace caplet::test {

/// All that operator new has given out since the program started, freed or not.
std::uint64_t allocated_bytes();

}  // namespace caplet::test
