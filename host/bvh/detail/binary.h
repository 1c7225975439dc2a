// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This is the binary tree between references and wide nodes; it is private to this room.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "bvh/bvh.h"

namespace caplet::bvh {

struct Box {
  std::array<float, 3> min{inf, inf, inf}, max{-inf, -inf, -inf};
  static constexpr float inf = std::numeric_limits<float>::infinity();

  void extend(const Box& b) {
    for (std::size_t k = 0; k < 3; k++) {
      min[k] = std::min(min[k], b.min[k]);
      max[k] = std::max(max[k], b.max[k]);
    }
  }
  /// Returns half the surface area; 0 when empty. It is in double, so that no finite box overflows.
  double area() const {
    if (!(min[0] <= max[0])) return 0;
    const double x = double(max[0]) - double(min[0]), y = double(max[1]) - double(min[1]),
                 z = double(max[2]) - double(min[2]);
    return x * y + y * z + z * x;
  }
};

struct BinaryNode {
  std::array<float, 3> min, max;
  std::uint32_t left;          // the right one follows it; 0: leaf, for the root is no child
  std::uint32_t first, count;  // range of the ordered references
  Box box() const { return {min, max}; }
};

struct BinaryTree {
  std::vector<Reference> items;  // in leaf order; `primitive` is the index into those given
  std::unique_ptr<BinaryNode[]> nodes;
  std::uint32_t node_count = 0;
};

/// Builds the tree. Node 0 is the root. Numbers of the other nodes depend on timing; the tree's
/// shape does not.
BinaryTree build_binary(std::vector<Reference> references, std::uint64_t single_groups,
                        Effort effort);

/// Returns the wide nodes of least cost over the binary tree.
Tree collapse(BinaryTree binary);

}  // namespace caplet::bvh
