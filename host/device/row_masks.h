// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Says which kinds of things a program is built for.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>

namespace caplet {

/// These are the rows of lists in kernels/shared that a program has, by the list's name: bit n of
/// the mask of "shapes" is row n of shapes.def. A list that is not named has all rows. Kernels see
/// the mask as CAPLET_SHAPES.
using RowMasks = std::map<std::string, std::uint64_t, std::less<>>;

}  // namespace caplet
