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

/// Does as encode_tree of encode.h, with linked capsules beside the primitives. They have no slots.
/// `release`: see LinkedCapsules::append.
EncodedTree encode_tree(std::span<const FlatPrimitive> primitives, const TreeLinks& linked,
                        bool release, std::vector<float>& nodes, std::vector<float>& leaves,
                        int kind_bits);

}  // namespace caplet
