// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Primitives and their tree -> the flat node and leaf arrays (shared/kinds.h, shared/shapes.def).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace caplet {

/// One primitive: data as the data rows of shapes.def, in the space of its tree. Instances carry their box (min 3, max 3) in
/// data[0..5], polyhedra and csg shapes in data[3..8].
struct FlatPrimitive {
  std::uint32_t shape;
  std::uint32_t id;  // global primitive id; for instances the index into FlatScene::instances
  float data[12];
};

struct EncodedTree {
  std::uint32_t root = 0;            // node index
  std::vector<std::uint32_t> slots;  // of each primitive given
  float min[3] = {0, 0, 0}, max[3] = {0, 0, 0};
  std::uint64_t nodes = 0;
  int depth = 0;
  double sah = 0;
};

/// The exact box of a primitive in its tree's space: min, then max.
void primitive_box(const FlatPrimitive& p, double min[3], double max[3]);

/// Rows of leaf blocks that so many primitives of each kind (shapes.def) take at the very least.
std::uint64_t least_rows(std::span<const std::uint64_t> counts);
/// Throws InputError when there are more rows of leaf blocks or nodes than references have bits for: 2^27 rows, some 100 million
/// capsules, and 2^31 nodes.
void check_tree_limits(std::uint64_t rows, std::uint64_t nodes);

/// Builds the tree over `primitives` (at least one) and appends nodes and leaf blocks. Boxes are conservative: they hold every
/// point the shape kernels may report, their rounding included. Throws InputError when rows or nodes exceed the layout, before
/// allocating.
EncodedTree encode_tree(std::span<const FlatPrimitive> primitives, std::vector<float>& nodes, std::vector<float>& leaves);

}  // namespace caplet
