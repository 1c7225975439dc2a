// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Whether `./run test --all` runs, for tests whose full size takes half a minute or more.
#pragma once

#include <cstdlib>

namespace caplet::test {

inline bool thorough() { return std::getenv("CAPLET_THOROUGH") != nullptr; }

}  // namespace caplet::test
