// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Chooses which binary nodes become wide ones: least expected cost by dynamic programming over
// "this subtree as at most i children" (Ylitie, Karras and Laine, "Efficient incoherent ray
// traversal on GPUs through compressed wide BVHs", HPG 2017).
#include <tbb/parallel_invoke.h>

#include "base/check.h"
#include "bvh/detail/binary.h"

namespace caplet::bvh {
namespace {

constexpr double node_cost = 1.0, leaf_cost = 1.0;
constexpr std::uint32_t no_root = 0xffffffff;
constexpr std::uint32_t parallel_nodes = 4096;

/// cost[i] is the least cost of the subtree as at most i + 1 roots (each a wide node or a leaf).
/// left[i] is how many of these the left child gets; 0: the subtree stays one root.
struct Choice {
  std::array<float, width> cost;
  std::array<std::uint8_t, width> left;
};

class Collapser {
 public:
  explicit Collapser(const BinaryTree& binary)
      : binary_(binary), choices_(std::make_unique_for_overwrite<Choice[]>(binary.node_count)) {}

  Tree run() {
    scale_ = 1 / std::max(binary_.nodes[0].box().area(), std::numeric_limits<double>::min());
    choose(0);
    tree_.order.reserve(binary_.count);
    for (std::uint32_t i = 0; i < binary_.count; i++)
      tree_.order.push_back(binary_.items[i].primitive);
    emit(0, 1);
    return std::move(tree_);
  }

 private:
  float relative_area(const BinaryNode& node) const {
    return static_cast<float>(node.box().area() * scale_);
  }

  void choose(std::uint32_t index) {
    const BinaryNode& node = binary_.nodes[index];
    Choice& choice = choices_[index];
    const float area = relative_area(node);
    if (node.left == 0) {
      choice.cost.fill(area * static_cast<float>(leaf_cost));
      choice.left.fill(0);
      return;
    }
    if (node.count > parallel_nodes) {
      tbb::parallel_invoke([&] { choose(node.left); }, [&] { choose(node.right); });
    } else {
      choose(node.left);
      choose(node.right);
    }
    const Choice &a = choices_[node.left], &b = choices_[node.right];
    for (std::size_t i = width; i-- > 1;) {
      choice.cost[i] = std::numeric_limits<float>::infinity();
      for (std::size_t l = 1; l <= i; l++) {
        const float cost = a.cost[l - 1] + b.cost[i - l];
        if (cost < choice.cost[i]) {
          choice.cost[i] = cost;
          choice.left[i] = static_cast<std::uint8_t>(l);
        }
      }
    }
    opened_cost(choice, area);
  }

  /// Computes the cost as one root: a wide node over the best eight. With more roots allowed it is
  /// still possible to stay one root.
  static void opened_cost(Choice& choice, float area) {
    choice.left[0] = 0;
    choice.cost[0] = area * static_cast<float>(node_cost) + choice.cost[width - 1];
    for (std::size_t i = 1; i + 1 < width; i++)
      if (choice.cost[0] < choice.cost[i]) {
        choice.cost[i] = choice.cost[0];
        choice.left[i] = 0;
      }
  }

  /// Adds the roots of subtree `index`, at most `allowed`; `open`: the subtree itself must not be
  /// one of them.
  void gather(std::uint32_t index, std::size_t allowed, bool open,
              std::vector<std::uint32_t>& roots) const {
    const BinaryNode& node = binary_.nodes[index];
    const std::size_t left = node.left == 0 ? 0 : choices_[index].left[allowed - 1];
    if (left == 0 && !(open && node.left != 0)) {
      roots.push_back(index);
      return;
    }
    gather(node.left, left, false, roots);
    gather(node.right, allowed - left, false, roots);
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
        tree_.leaves.push_back({root.first, root.count, binary_.items[root.first].group});
        tree_.sah += leaf_cost * root.box().area() * scale_;
      } else {
        child = emit(slots[i], depth + 1);
      }
      tree_.nodes[static_cast<std::size_t>(at)].child[i] = child;
    }
    return at;
  }

  const BinaryTree& binary_;
  std::unique_ptr<Choice[]> choices_;
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

Tree collapse(const BinaryTree& binary) { return Collapser(binary).run(); }

Tree build(std::span<const Reference> references, std::uint64_t single_groups, Effort effort) {
  CHECK_LT_(references.size(), std::size_t(1) << 31);
  if (references.empty()) return childless_root();
  return collapse(build_binary(references, single_groups, effort));
}

}  // namespace caplet::bvh
