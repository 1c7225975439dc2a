// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Chooses which binary nodes become wide ones: least expected cost by dynamic programming over
// "this subtree as at most i children" (Ylitie, Karras and Laine, "Efficient incoherent ray
// traversal on GPUs through compressed wide BVHs", HPG 2017).
#include <tbb/parallel_invoke.h>

#include <memory>
#include <utility>

#include "base/check.h"
#include "bvh/detail/binary.h"

namespace caplet::bvh {
namespace {

constexpr double node_cost = 1.0, leaf_cost = 1.0;
constexpr std::uint32_t no_root = 0xffffffff;
constexpr std::uint32_t parallel_nodes = 4096;

/// Costs[i] is the least cost of a subtree as at most i + 1 roots (each a wide node or a leaf).
using Costs = std::array<float, width>;
/// Lefts[i] says how many of i + 1 roots the left child of an inner node gets; 0: the subtree stays
/// one root.
using Lefts = std::array<std::uint8_t, width>;

class Collapser {
 public:
  explicit Collapser(BinaryTree binary)
      : binary_(std::move(binary)),
        costs_(std::make_unique_for_overwrite<Costs[]>(binary_.node_count / 2)),
        lefts_(std::make_unique_for_overwrite<Lefts[]>(binary_.node_count / 2)) {}

  Tree run() {
    scale_ = 1 / std::max(binary_.nodes[0].box().area(), std::numeric_limits<double>::min());
    const std::size_t count = binary_.items.size();
    tree_.order.reserve(count);
    groups_.reserve(count);
    for (const Reference& item : binary_.items) {
      tree_.order.push_back(item.primitive);
      groups_.push_back(static_cast<std::uint8_t>(item.group));
    }
    binary_.items = {};
    choose(0);
    costs_.reset();
    // Nodes have more than four children nearly always. Room that is not used takes no memory.
    tree_.nodes.reserve(count / 4 + 1);
    tree_.leaves.reserve(count);
    emit(0, 1);
    return std::move(tree_);
  }

 private:
  float relative_area(const BinaryNode& node) const {
    return static_cast<float>(node.box().area() * scale_);
  }

  /// Returns the number of an inner node among inner nodes. Children are made in pairs, from number
  /// 1 on.
  static std::size_t inner(const BinaryNode& node) { return (node.left - 1) / 2; }

  Costs costs_of(std::uint32_t index) const {
    const BinaryNode& node = binary_.nodes[index];
    if (node.left != 0) return costs_[inner(node)];
    Costs costs;
    costs.fill(relative_area(node) * static_cast<float>(leaf_cost));
    return costs;
  }

  void choose(std::uint32_t index) {
    const BinaryNode& node = binary_.nodes[index];
    if (node.left == 0) return;
    if (node.count > parallel_nodes) {
      tbb::parallel_invoke([&] { choose(node.left); }, [&] { choose(node.left + 1); });
    } else {
      choose(node.left);
      choose(node.left + 1);
    }
    Costs& cost = costs_[inner(node)];
    Lefts& left = lefts_[inner(node)];
    const Costs a = costs_of(node.left), b = costs_of(node.left + 1);
    for (std::size_t i = width; i-- > 1;) {
      cost[i] = std::numeric_limits<float>::infinity();
      for (std::size_t l = 1; l <= i; l++) {
        const float sum = a[l - 1] + b[i - l];
        if (sum < cost[i]) {
          cost[i] = sum;
          left[i] = static_cast<std::uint8_t>(l);
        }
      }
    }
    open(relative_area(node), cost, left);
  }

  /// Computes the cost as one root: a wide node over the best eight. With more roots allowed it is
  /// still possible to stay one root.
  static void open(float area, Costs& cost, Lefts& left) {
    left[0] = 0;
    cost[0] = area * static_cast<float>(node_cost) + cost[width - 1];
    for (std::size_t i = 1; i + 1 < width; i++)
      if (cost[0] < cost[i]) {
        cost[i] = cost[0];
        left[i] = 0;
      }
  }

  /// Adds the roots of subtree `index`, at most `allowed`; `open`: the subtree itself must not be
  /// one of them.
  void gather(std::uint32_t index, std::size_t allowed, bool open,
              std::vector<std::uint32_t>& roots) const {
    const BinaryNode& node = binary_.nodes[index];
    const std::size_t left = node.left == 0 ? 0 : lefts_[inner(node)][allowed - 1];
    if (left == 0 && !(open && node.left != 0)) {
      roots.push_back(index);
      return;
    }
    gather(node.left, left, false, roots);
    gather(node.left + 1, allowed - left, false, roots);
  }

  /// Returns the roots in the order of slots. Pairs of a root and a slot are chosen best first, by
  /// how well the slot number's bits match the octant of the node that the root lies in (bit k:
  /// towards larger values along axis k). A ray meets the slots nearly in the order of slot ^
  /// octant of its direction (Ylitie et al. 2017, section 3.3).
  std::array<std::uint32_t, width> placed(std::uint32_t index,
                                          const std::vector<std::uint32_t>& roots) const {
    std::array<std::uint32_t, width> slots;
    slots.fill(no_root);
    const Box all = binary_.nodes[index].box();
    std::array<std::array<float, width>, width> gain{};  // root, slot
    for (std::size_t r = 0; r < roots.size(); r++) {
      const Box box = binary_.nodes[roots[r]].box();
      for (std::size_t s = 0; s < width; s++)
        for (std::size_t k = 0; k < 3; k++) {
          const float off = 0.5f * (box.min[k] - all.min[k]) + 0.5f * (box.max[k] - all.max[k]);
          gain[r][s] += (s >> k & 1) != 0 ? off : -off;
        }
    }
    std::array<bool, width> done{};
    for (std::size_t n = 0; n < roots.size(); n++) {
      std::size_t best_root = width, best_slot = 0;
      for (std::size_t r = 0; r < roots.size(); r++)
        for (std::size_t s = 0; s < width; s++)
          if (!done[r] && slots[s] == no_root &&
              (best_root == width || gain[r][s] > gain[best_root][best_slot])) {
            best_root = r;
            best_slot = s;
          }
      done[best_root] = true;
      slots[best_slot] = roots[best_root];
    }
    return slots;
  }

  std::int32_t emit(std::uint32_t index, int depth) {
    const std::int32_t at = narrow<std::int32_t>(tree_.nodes.size());
    tree_.nodes.emplace_back();
    tree_.depth = std::max(tree_.depth, depth);
    tree_.sah += node_cost * binary_.nodes[index].box().area() * scale_;
    std::vector<std::uint32_t> roots;
    gather(index, width, true, roots);
    const std::array<std::uint32_t, width> slots = placed(index, roots);
    for (std::size_t i = 0; i < width; i++) {
      const Box box = slots[i] != no_root ? binary_.nodes[slots[i]].box() : Box{};
      for (std::size_t k = 0; k < 3; k++) {
        tree_.nodes[static_cast<std::size_t>(at)].min[k][i] = box.min[k];
        tree_.nodes[static_cast<std::size_t>(at)].max[k][i] = box.max[k];
      }
      tree_.nodes[static_cast<std::size_t>(at)].child[i] = 0x7fffffff;
    }
    for (std::size_t i = 0; i < width; i++) {
      if (slots[i] == no_root) continue;
      const BinaryNode& root = binary_.nodes[slots[i]];
      std::int32_t child = 0;
      if (root.left == 0) {
        child = ~narrow<std::int32_t>(tree_.leaves.size());
        tree_.leaves.push_back({root.first, root.count, groups_[root.first]});
        tree_.sah += leaf_cost * root.box().area() * scale_;
      } else {
        child = emit(slots[i], depth + 1);
      }
      tree_.nodes[static_cast<std::size_t>(at)].child[i] = child;
    }
    return at;
  }

  BinaryTree binary_;
  std::unique_ptr<Costs[]> costs_;  // of inner nodes
  std::unique_ptr<Lefts[]> lefts_;
  std::vector<std::uint8_t> groups_;  // of the items
  Tree tree_;
  double scale_ = 1;
};

Tree childless_root() {
  Tree tree;
  tree.depth = 1;
  Node& root = tree.nodes.emplace_back();
  const Box nothing;
  for (std::size_t i = 0; i < width; i++) {
    for (std::size_t k = 0; k < 3; k++) {
      root.min[k][i] = nothing.min[k];
      root.max[k][i] = nothing.max[k];
    }
    root.child[i] = 0x7fffffff;
  }
  return tree;
}

}  // namespace

Tree collapse(BinaryTree binary) { return Collapser(std::move(binary)).run(); }

Tree build(std::vector<Reference> references, std::uint64_t single_groups, Effort effort) {
  CHECK_LT_(references.size(), std::size_t(1) << 31);
  if (references.empty()) return childless_root();
  return collapse(build_binary(std::move(references), single_groups, effort));
}

}  // namespace caplet::bvh
