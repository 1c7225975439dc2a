// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Converts primitives and their tree to the flat node and leaf arrays (shared/kinds.h,
// shared/shapes.def).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "lower/flat_primitive.h"
#include "lower/reference_box.h"

namespace caplet {

struct EncodedTree {
  std::uint32_t root = 0;            // node index
  std::uint32_t intervals = 0;       // as in WorldRecord: what moves may have several trees
  std::uint32_t roots_begin = 0;     // WorldRecord.roots
  std::vector<std::uint32_t> slots;  // of each primitive given: HitRecord.slot, of one of the trees
  float min[3] = {0, 0, 0}, max[3] = {0, 0, 0};
  std::vector<ReferenceBox> boxes{};  // of the trees of intervals, where they are several
  std::uint64_t nodes = 0;
  int depth = 0;
  double sah = 0;
};

/// Returns the least number of rows of leaf blocks that so many primitives of each kind
/// (shapes.def) need.
std::uint64_t least_rows(std::span<const std::uint64_t> counts);
/// Returns the bits that leaf references need for these kinds (bit k: shape kind k), the program
/// option CAPLET_LEAF_KIND_BITS: 4, and more where there are kinds from 16 up.
int leaf_kind_bits(std::uint64_t shapes);
/// Throws InputError when there are more rows of leaf blocks or nodes than references have bits
/// for: with 4 bits for the kind 2^27 rows, some 100 million capsules, and 2^31 nodes.
void check_tree_limits(std::uint64_t rows, std::uint64_t nodes, int kind_bits);

/// Builds the tree over `primitives` (at least one) and appends nodes and leaf blocks. Boxes are
/// conservative: they hold every point the shape kernels may report, their rounding included.
/// Throws InputError when rows or nodes exceed the layout, before allocating. `kind_bits`: see
/// leaf_kind_bits; all trees of a scene have the same.
EncodedTree encode_tree(std::span<const FlatPrimitive> primitives, std::vector<float>& nodes,
                        std::vector<float>& leaves, int kind_bits = CAPLET_LEAF_KIND_BITS);

}  // namespace caplet
