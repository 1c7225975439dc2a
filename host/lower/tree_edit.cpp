// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "lower/detail/tree_edit.h"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>

#include "base/check.h"
#include "lower/detail/floats.h"
#include "shared/shapes.h"

namespace caplet {

namespace {

constexpr ReferenceBox nothing{{inf, inf, inf}, {-inf, -inf, -inf}};

void extend(ReferenceBox& box, const ReferenceBox& other) {
  for (int k = 0; k < 3; ++k) {
    box.min[k] = std::min(box.min[k], other.min[k]);
    box.max[k] = std::max(box.max[k], other.max[k]);
  }
}

/// Returns half the area; 0 when empty.
double area(const ReferenceBox& box) {
  double side[3];
  for (int k = 0; k < 3; ++k) {
    side[k] = double(box.max[k]) - double(box.min[k]);
    if (!(side[k] >= 0)) return 0;
  }
  return side[0] * side[1] + side[1] * side[2] + side[2] * side[0];
}

ReferenceBox clipped(ReferenceBox box, const ReferenceBox& to) {
  for (int k = 0; k < 3; ++k) {
    box.min[k] = std::max(box.min[k], to.min[k]);
    box.max[k] = std::min(box.max[k], to.max[k]);
  }
  return box;
}

bool same(const ReferenceBox& a, const ReferenceBox& b) {
  using Bits = std::array<std::uint32_t, 6>;
  return std::bit_cast<Bits>(a) == std::bit_cast<Bits>(b);
}

ReferenceBox bounds_of(const EncodedTree& tree) {
  ReferenceBox box;
  std::copy_n(tree.min, 3, box.min);
  std::copy_n(tree.max, 3, box.max);
  return box;
}

}  // namespace

TreeEdit::TreeEdit(FlatScene& flat, LoweredGeometry& geometry)
    : flat_(flat),
      geometry_(geometry),
      node_parent_(flat.nodes.size() / CAPLET_NODE_FLOATS, CAPLET_NONE),
      row_parent_((flat.leaves.size() + 7) / 8, CAPLET_NONE) {
  CHECK_LT_(node_parent_.size(), std::size_t{1} << 29);
  const std::uint32_t row_mask = (1u << (31 - flat.leaf_kind_bits)) - 1;
  for (std::uint32_t node = 0; node < node_parent_.size(); ++node)
    for (std::uint32_t i = 0; i < 8; ++i) {
      const auto child = std::bit_cast<std::uint32_t>(
          flat.nodes[std::size_t{node} * CAPLET_NODE_FLOATS + CAPLET_NODE_CHILDREN + i]);
      if (child == no_child) continue;
      (child >> 31 ? row_parent_[child & row_mask] : node_parent_[child]) = node * 8 + i;
    }
}

void TreeEdit::leaves_have_grown() {
  row_parent_.resize((flat_.leaves.size() + 7) / 8, CAPLET_NONE);
}

const FlatPrimitive& TreeEdit::primitive(const Subtree& subtree, std::uint32_t kind,
                                         std::uint32_t id) const {
  if (kind == shape_instance) return subtree.primitives[geometry_.placed[id].top];
  const bool is_top = &subtree == &geometry_.world.subtrees[0] && !geometry_.placed.empty();
  const auto end =
      is_top ? subtree.primitives.begin() + static_cast<std::ptrdiff_t>(geometry_.placed[0].top)
             : subtree.primitives.end();
  const auto found =
      std::ranges::lower_bound(subtree.primitives.begin(), end, id, {}, &FlatPrimitive::id);
  CHECK_EQ_(found != end && found->id == id, true);
  return *found;
}

ReferenceBox TreeEdit::box_of(std::uint32_t node, std::uint32_t i) const {
  const float* at = &flat_.nodes[std::size_t{node} * CAPLET_NODE_FLOATS + i];
  return {{at[0], at[8], at[16]}, {at[24], at[32], at[40]}};
}

ReferenceBox TreeEdit::bounds_of_node(std::uint32_t node) const {
  ReferenceBox box = nothing;
  for (std::uint32_t i = 0; i < 8; ++i) extend(box, box_of(node, i));
  return box;
}

void TreeEdit::set_box(std::uint32_t node, std::uint32_t i, const ReferenceBox& box, Cost& cost) {
  const ReferenceBox before = box_of(node, i);
  cost.areas += area(box) - area(before);
  cost.clipped += area(clipped(box, cost.bounds)) - area(clipped(before, cost.bounds));
  float* at = &flat_.nodes[std::size_t{node} * CAPLET_NODE_FLOATS + i];
  for (int k = 0; k < 3; ++k) {
    at[8 * k] = box.min[k];
    at[8 * (3 + k)] = box.max[k];
  }
}

ReferenceBox TreeEdit::leaf_box(const Subtree& subtree, std::uint32_t row) const {
  const std::uint32_t parent = row_parent_[row];
  const auto reference = std::bit_cast<std::uint32_t>(
      flat_
          .nodes[std::size_t{parent / 8} * CAPLET_NODE_FLOATS + CAPLET_NODE_CHILDREN + parent % 8]);
  const std::uint32_t kind =
      reference >> (31 - flat_.leaf_kind_bits) & ((1u << flat_.leaf_kind_bits) - 1);
  ReferenceBox box = nothing;
  for (std::uint32_t lane = 0; lane < 8; ++lane) {
    const auto id = std::bit_cast<std::uint32_t>(flat_.leaves[std::size_t{row} * 8 + lane]);
    if (id != CAPLET_NONE) extend(box, reference_box(primitive(subtree, kind, id)));
  }
  return box;
}

void TreeEdit::write_lanes(const Subtree& subtree, std::size_t at, SceneChanges& changes) {
  const FlatPrimitive& p = subtree.primitives[at];
  const std::uint32_t slot = subtree.tree.slots[at], rows = rows_of(p.shape);
  float* block = &flat_.leaves[std::size_t{slot / 8} * 8];
  for (std::uint32_t lane = 0; lane < 8; ++lane) {
    // Empty lanes repeat the first primitive.
    const bool repeats = slot % 8 == 0 && std::bit_cast<std::uint32_t>(block[lane]) == CAPLET_NONE;
    if (lane != slot % 8 && !repeats) continue;
    for (std::uint32_t j = 0; j + 1 < rows; ++j) block[8 * (j + 1) + lane] = p.data[j];
  }
  if (rows > 1) changes.leaves.add(std::size_t{slot / 8} * 8 + 8, std::size_t{rows - 1} * 8);
}

void TreeEdit::move(Subtree& subtree, std::size_t at, SceneChanges& changes) {
  Cost& cost = costs_[&subtree];
  if (cost.built == 0) {
    cost.bounds = bounds_of(subtree.tree);
    cost.built = subtree.tree.sah;
    cost.areas = cost.clipped = subtree.tree.sah * area(cost.bounds);
  }
  write_lanes(subtree, at, changes);
  const std::uint32_t row = subtree.tree.slots[at] / 8;
  ReferenceBox box = leaf_box(subtree, row);
  std::uint32_t link = row_parent_[row];
  while (link != CAPLET_NONE) {
    const std::uint32_t node = link / 8;
    if (same(box, box_of(node, link % 8))) return;
    set_box(node, link % 8, box, cost);
    changes.nodes.add(std::size_t{node} * CAPLET_NODE_FLOATS, CAPLET_NODE_CHILDREN);
    box = bounds_of_node(node);
    link = node_parent_[node];
  }
  const ReferenceBox before = bounds_of(subtree.tree);
  cost.areas += area(box) - area(before);
  cost.clipped += area(clipped(box, cost.bounds)) - area(clipped(before, cost.bounds));
  std::copy_n(box.min, 3, subtree.tree.min);
  std::copy_n(box.max, 3, subtree.tree.max);
}

double TreeEdit::cost_growth(const Subtree& subtree) const {
  const auto found = costs_.find(&subtree);
  if (found == costs_.end()) return 1;
  const Cost& cost = found->second;
  const double now = area(bounds_of(subtree.tree)), then = area(cost.bounds);
  if (!(now > 0 && then > 0 && cost.built > 0)) return 1;
  return std::max(cost.areas / now, cost.clipped / then) / cost.built;
}

}  // namespace caplet
