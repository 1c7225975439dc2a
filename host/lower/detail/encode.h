// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Builds trees that have linked capsules.
#pragma once

#include <span>
#include <vector>

#include "lower/detail/linked_capsules.h"
#include "lower/encode.h"

namespace caplet {

/// TreeItems are what a tree is built over.
struct TreeItems {
  std::span<const FlatPrimitive> primitives;
  const LooseCapsules& loose;
  const TreeLinks& linked;
};

/// Does as encode_tree of encode.h. Only primitives have slots. `release`: see
/// LinkedCapsules::append.
EncodedTree encode_tree(const TreeItems& items, bool release, std::vector<float>& nodes,
                        std::vector<float>& leaves, int kind_bits);

}  // namespace caplet
