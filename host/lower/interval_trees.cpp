// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "lower/detail/interval_trees.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>

#include "base/check.h"
#include "lower/detail/floats.h"

namespace caplet {

namespace {

constexpr std::uint32_t most_intervals = 16;
/// All trees together have no more references to what moves: some 440 MB (26 bytes each).
constexpr std::size_t most_references = std::size_t{1} << 24;
/// The number of intervals follows from so many of the primitives.
constexpr std::size_t most_looked_at = 256;
/// What a halving of the intervals must save for the trees that it costs.
constexpr double halving_saves = 1.25;

float time_of(std::uint32_t interval, std::uint32_t of) {
  return static_cast<float>(interval) / static_cast<float>(of);
}

double half_area(const FlatPrimitive& p) {
  const float* box = p.kept_box();
  const double x = double{box[3]} - double{box[0]}, y = double{box[4]} - double{box[1]},
               z = double{box[5]} - double{box[2]};
  return x * y + y * z + z * x;
}

class IntervalTrees {
 public:
  IntervalTrees(const TreeItems& items, const MovingBoxes& boxes, std::vector<float>& nodes,
                std::vector<float>& leaves, int kind_bits)
      : items_(items), boxes_(boxes), nodes_(nodes), leaves_(leaves), kind_bits_(kind_bits) {
    for (std::size_t i = 0; i < items.primitives.size(); ++i)
      (boxes.moves(items.primitives[i]) ? moving_ : resting_)
          .push_back(static_cast<std::uint32_t>(i));
  }

  EncodedTree run(bool release) {
    const std::uint32_t intervals = moving_.empty() ? 1 : best_intervals();
    if (intervals == 1) return encode_tree(items_, release, nodes_, leaves_, kind_bits_);
    EncodedTree out;
    out.slots.resize(items_.primitives.size());
    const bool is_apart =
        resting_.size() > moving_.size() || items_.loose.size() + items_.linked.size() > 0;
    EncodedTree rest;
    if (is_apart) {
      rest = encode_resting(release, out.slots);
    } else {
      moving_.insert(moving_.end(), resting_.begin(), resting_.end());
      std::ranges::sort(moving_);
    }
    std::vector<std::uint32_t> roots;
    for (std::uint32_t i = 0; i < intervals; ++i) {
      set_boxes(time_of(i, intervals), time_of(i + 1, intervals));
      EncodedTree tree = encode_moving(out.slots);
      if (is_apart) tree = joined(rest, tree);
      add(tree, out);
      roots.push_back(tree.root);
    }
    if (is_apart) out.nodes += rest.nodes;
    out.sah /= intervals;
    out.root = roots[0];
    out.intervals = intervals;
    out.roots_begin = append_roots(roots);
    return out;
  }

 private:
  /// Returns the sum of the areas of boxes of some primitives, in the mean of the intervals.
  double area(std::uint32_t intervals) const {
    double sum = 0;
    const std::size_t step = (moving_.size() + most_looked_at - 1) / most_looked_at;
    for (std::size_t i = 0; i < moving_.size(); i += step) {
      FlatPrimitive p = items_.primitives[moving_[i]];
      for (std::uint32_t k = 0; k < intervals; ++k) {
        boxes_.set_box(p, time_of(k, intervals), time_of(k + 1, intervals));
        sum += half_area(p);
      }
    }
    return sum / intervals;
  }

  std::uint32_t best_intervals() const {
    std::uint32_t best = 1;
    double least = area(1), cost = 1;
    for (std::uint32_t n = 2; n <= most_intervals && n * moving_.size() <= most_references;
         n *= 2) {
      cost *= halving_saves;
      if (const double now = area(n) * cost; now < least) {
        least = now;
        best = n;
      }
    }
    return best;
  }

  void set_boxes(float begin, float end) {
    now_.resize(moving_.size());
    tbb::parallel_for(std::size_t{0}, moving_.size(), [&](std::size_t i) {
      now_[i] = items_.primitives[moving_[i]];
      if (boxes_.moves(now_[i])) boxes_.set_box(now_[i], begin, end);
    });
  }

  /// Encodes moving_ as they are in the interval.
  EncodedTree encode_moving(std::vector<std::uint32_t>& slots) {
    EncodedTree tree = encode_tree(now_, nodes_, leaves_, kind_bits_);
    for (std::size_t i = 0; i < moving_.size(); ++i) slots[moving_[i]] = tree.slots[i];
    return tree;
  }

  EncodedTree encode_resting(bool release, std::vector<std::uint32_t>& slots) {
    std::vector<FlatPrimitive> primitives;
    primitives.reserve(resting_.size());
    for (const std::uint32_t i : resting_) primitives.push_back(items_.primitives[i]);
    EncodedTree tree = encode_tree({primitives, items_.loose, items_.linked}, release, nodes_,
                                   leaves_, kind_bits_);
    for (std::size_t i = 0; i < resting_.size(); ++i) slots[resting_[i]] = tree.slots[i];
    return tree;
  }

  /// Appends a node whose children are two trees, and returns `b` with that node as its root.
  EncodedTree joined(const EncodedTree& a, EncodedTree b) {
    const std::size_t at = nodes_.size();
    nodes_.resize(at + CAPLET_NODE_FLOATS);
    for (std::size_t i = 0; i < CAPLET_WIDTH; ++i) {
      const EncodedTree* child = i == 0 ? &a : i == 1 ? &b : nullptr;
      for (std::size_t k = 0; k < 3; ++k) {
        nodes_[at + 8 * k + i] = child ? child->min[k] : inf;
        nodes_[at + 8 * (3 + k) + i] = child ? child->max[k] : -inf;
      }
      nodes_[at + CAPLET_NODE_CHILDREN + i] = std::bit_cast<float>(child ? child->root : no_child);
    }
    const double area_a = area_of(a), area_b = area_of(b);
    extend(b, a);
    // Visits of the two trees by lines through the box around both.
    if (const double all = area_of(b); all > 0) b.sah = 1 + (a.sah * area_a + b.sah * area_b) / all;
    b.root = narrow<std::uint32_t>(at / CAPLET_NODE_FLOATS);
    b.nodes += 1;
    b.depth = std::max(a.depth, b.depth) + 1;
    CHECK_LE_(b.depth, CAPLET_TREE_DEPTH_MAX);
    check_tree_limits(0, nodes_.size() / CAPLET_NODE_FLOATS, kind_bits_);
    return b;
  }

  static double area_of(const EncodedTree& tree) {
    std::array<double, 3> side;
    for (std::size_t k = 0; k < 3; ++k) side[k] = double{tree.max[k]} - double{tree.min[k]};
    return side[0] * side[1] + side[1] * side[2] + side[2] * side[0];
  }

  static void extend(EncodedTree& tree, const EncodedTree& by) {
    for (std::size_t k = 0; k < 3; ++k) {
      tree.min[k] = std::min(tree.min[k], by.min[k]);
      tree.max[k] = std::max(tree.max[k], by.max[k]);
    }
  }

  /// Adds a tree's figures to those of all.
  static void add(const EncodedTree& tree, EncodedTree& out) {
    if (out.boxes.empty()) {
      std::copy_n(tree.min, 3, out.min);
      std::copy_n(tree.max, 3, out.max);
    }
    extend(out, tree);
    ReferenceBox& box = out.boxes.emplace_back();
    std::copy_n(tree.min, 3, box.min);
    std::copy_n(tree.max, 3, box.max);
    out.nodes += tree.nodes;
    out.depth = std::max(out.depth, tree.depth);
    out.sah += tree.sah;
  }

  /// Returns where they lie in the leaves.
  std::uint32_t append_roots(const std::vector<std::uint32_t>& roots) {
    const auto begin = narrow<std::uint32_t>(leaves_.size());
    for (const std::uint32_t root : roots) leaves_.push_back(std::bit_cast<float>(root));
    while (leaves_.size() % 8 != 0) leaves_.push_back(0);
    return begin;
  }

  const TreeItems& items_;
  const MovingBoxes& boxes_;
  std::vector<float>&nodes_, &leaves_;
  int kind_bits_;
  std::vector<std::uint32_t> moving_, resting_;  // indices of primitives, in order
  std::vector<FlatPrimitive> now_;               // those of moving_, as they are in the interval
};

}  // namespace

EncodedTree encode_trees(const TreeItems& items, const MovingBoxes& boxes, bool release,
                         std::vector<float>& nodes, std::vector<float>& leaves, int kind_bits) {
  return IntervalTrees(items, boxes, nodes, leaves, kind_bits).run(release);
}

}  // namespace caplet
