// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Which kinds of things a program is built for.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>

namespace caplet {

/// Rows of lists in kernels/shared that a program has, by the list's name: bit n of the mask of "shapes" is row n of shapes.def.
/// Of a list that is not named it has all. Kernels see the mask as CAPLET_SHAPES.
using RowMasks = std::map<std::string, std::uint64_t, std::less<>>;

}  // namespace caplet
