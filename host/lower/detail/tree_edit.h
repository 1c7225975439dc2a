// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Moves primitives within encoded trees: their leaf blocks, and the boxes from there to the root.
#pragma once

#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "lower/changes.h"
#include "lower/detail/subtrees.h"
#include "lower/flat_scene.h"

namespace caplet {

class TreeEdit {
 public:
  /// Edits the trees in `flat`, which hold `geometry`.
  TreeEdit(FlatScene& flat, LoweredGeometry& geometry);

  /// Updates the tree after primitive `at` of `subtree` has changed in `subtree.primitives`.
  void move(Subtree& subtree, std::size_t at, SceneChanges& changes);
  /// Records that rows were appended to the leaves.
  void leaves_have_grown();

  /// Returns the subtree's expected cost of a ray now over that when it was built: for lines
  /// through its bounds, now or then, whichever is worse.
  double cost_growth(const Subtree& subtree) const;

 private:
  struct Cost {
    double built = 0, areas = 0,
           clipped = 0;  // areas of all boxes, whole and within the bounds that it was built with
    ReferenceBox bounds{};  // then
  };
  ReferenceBox leaf_box(const Subtree& subtree, std::uint32_t row) const;
  const FlatPrimitive& primitive(const Subtree& subtree, std::uint32_t kind,
                                 std::uint32_t id) const;
  void write_lanes(const Subtree& subtree, std::size_t at, SceneChanges& changes);
  /// Sets the box of child `i` of a node.
  void set_box(std::uint32_t node, std::uint32_t i, const ReferenceBox& box, Cost& cost);
  ReferenceBox box_of(std::uint32_t node, std::uint32_t i) const;
  ReferenceBox bounds_of_node(std::uint32_t node) const;

  FlatScene& flat_;
  LoweredGeometry& geometry_;
  // These are, by node and by the first row of a leaf block, the parent node times 8 plus the
  // number of the child.
  std::vector<std::uint32_t> node_parent_, row_parent_;
  std::unordered_map<const Subtree*, Cost> costs_;
};

}  // namespace caplet
