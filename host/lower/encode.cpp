// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "lower/encode.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "base/check.h"
#include "base/error.h"
#include "bvh/bvh.h"
#include "lower/detail/encode.h"
#include "lower/detail/floats.h"

namespace caplet {
namespace {

static_assert(bvh::max_depth + 1 == CAPLET_TREE_DEPTH_MAX, "trees may be joined by one more node");
static_assert(bvh::width == CAPLET_WIDTH);
static_assert(shape_count <= 64, "sets of shapes, and six bits of leaf references, hold 64 kinds");

constexpr std::uint64_t max_rows(int kind_bits) { return std::uint64_t(1) << (31 - kind_bits); }
constexpr std::uint64_t max_nodes = std::uint64_t(1) << 31;

}  // namespace

std::uint64_t least_rows(std::span<const std::uint64_t> counts) {
  CHECK_EQ_(counts.size(), std::size_t(shape_count));
  std::uint64_t rows = 0;
  for (std::size_t s = 0; s < counts.size(); s++)
    rows += (counts[s] + 7) / 8 * rows_of(static_cast<std::uint32_t>(s));
  return rows;
}

int leaf_kind_bits(std::uint64_t shapes) {
  const auto highest = static_cast<unsigned>(std::bit_width(shapes | 1) - 1);
  return std::max(4, static_cast<int>(std::bit_width(highest)));
}

void check_tree_limits(std::uint64_t rows, std::uint64_t nodes, int kind_bits) {
  const std::uint64_t most = max_rows(kind_bits);
  if (rows > most)
    throw InputError(fmt::format(
        "the scene needs {} rows of primitives, the layout holds {}: about {} million capsules",
        rows, most, most / 8 * 6 / 1000000));
  if (nodes > max_nodes)
    throw InputError(
        fmt::format("the scene needs {} tree nodes, the layout holds {}", nodes, max_nodes));
}

namespace {

/// Puts blocks of `floats` each into another order: block i becomes the one that was number
/// `source[i]`, of which each stands there once. `source` is then of any values.
void reorder_blocks(float* blocks, std::size_t floats, std::vector<std::uint32_t>& source) {
  constexpr std::uint32_t done = 0xffffffffu;
  std::vector<float> first(floats);
  for (std::uint32_t begin = 0; begin < source.size(); ++begin) {
    if (source[begin] == done) continue;
    std::copy_n(blocks + floats * begin, floats, first.data());
    std::uint32_t to = begin;
    while (source[to] != begin) {
      const std::uint32_t from = source[to];
      std::copy_n(blocks + floats * from, floats, blocks + floats * to);
      source[to] = done;
      to = from;
    }
    std::copy_n(first.data(), floats, blocks + floats * to);
    source[to] = done;
  }
}

/// TreeEncoder appends one tree to nodes and leaves. Blocks of linked capsules come first in the
/// leaves, those of chains after the others. They are written in the order of their shapes, whose
/// memory may be given back so, before the tree says which follows which.
class TreeEncoder {
 public:
  TreeEncoder(const TreeItems& items, std::vector<float>& nodes, std::vector<float>& leaves,
              int kind_bits)
      : primitives_(items.primitives),
        loose_(items.loose),
        linked_(items.linked),
        nodes_(nodes),
        leaves_(leaves),
        kind_bits_(kind_bits),
        node_base_(nodes.size() / CAPLET_NODE_FLOATS),
        row_base_(leaves.size() / 8) {}

  EncodedTree run(bool release) {
    rows_ = row_base_;
    for (const LinkedCapsules& form : linked_.by_form)
      rows_ += std::uint64_t{form.blocks()} * form.rows_per_block();
    // These are the least numbers of rows, before anything is allocated.
    const std::uint64_t least = least_rows(count_kinds());
    check_tree_limits(rows_ + least, node_base_ + 1, kind_bits_);
    if (rows_ > row_base_) leaves_.reserve((rows_ + least * 3 / 2) * 8);
    leaves_.resize(row_base_ * 8);
    tree_ = bvh::build(references(release),
                       shape_bit(shape_instance) | shape_bit(shape_linked_capsule));
    CHECK_LE_(tree_.depth, bvh::max_depth);
    place_leaves();
    EncodedTree out = described();
    write_nodes(out.root);
    tree_.nodes = {};
    write_primitives(out.slots);
    return out;
  }

 private:
  std::array<std::uint64_t, shape_count> count_kinds() const {
    std::array<std::uint64_t, shape_count> counts{};
    for (const FlatPrimitive& p : primitives_) {
      CHECK_LT_(p.shape, std::uint32_t(shape_count));
      CHECK_LT_(p.shape >> kind_bits_, 1u);
      CHECK_EQ_(shape_has(p.shape, trait_linked), false);
      counts[p.shape]++;
    }
    for (std::size_t kind = 0; kind < counts.size(); kind++) counts[kind] += loose_.counts()[kind];
    return counts;
  }

  /// Returns how many items are no blocks of linked capsules. They come first.
  std::size_t single_count() const { return primitives_.size() + loose_.size(); }
  FlatPrimitive single(std::size_t i) const {
    return i < primitives_.size() ? primitives_[i] : loose_[i - primitives_.size()];
  }

  /// Returns boxes of the items, and writes the blocks of linked capsules.
  std::vector<bvh::Reference> references(bool release) {
    std::size_t item = single_count();
    std::vector<bvh::Reference> out(item + linked_.by_form[0].blocks() +
                                    linked_.by_form[1].blocks());
    const auto set = [&](std::size_t i, const ReferenceBox& box, std::uint32_t group) {
      std::copy_n(box.min, 3, out[i].min);
      std::copy_n(box.max, 3, out[i].max);
      out[i].primitive = narrow<std::uint32_t>(i);
      out[i].group = group;
    };
    tbb::parallel_for(std::size_t(0), single_count(), [&](std::size_t i) {
      const FlatPrimitive p = single(i);
      set(i, reference_box(p), p.shape);
    });
    for (const LinkedCapsules& form : linked_.by_form) {
      const auto set_block = [&](std::size_t block, const ReferenceBox& box) {
        set(item + block, box, shape_linked_capsule);
      };
      form.append(leaves_, set_block, release);
      item += form.blocks();
    }
    return out;
  }

  /// Chooses the first rows of all leaves, and puts the blocks of linked capsules into the tree's
  /// order.
  void place_leaves() {
    row_of_.resize(tree_.leaves.size());
    std::array<std::vector<std::uint32_t>, 2> blocks;  // in the tree's order
    std::array<std::uint64_t, 2> base{row_base_, row_base_};
    base[1] += linked_.by_form[0].blocks() * linked_.by_form[0].rows_per_block();
    for (std::size_t f = 0; f < blocks.size(); ++f) blocks[f].reserve(linked_.by_form[f].blocks());
    for (std::size_t i = 0; i < tree_.leaves.size(); i++) {
      const bvh::Leaf& leaf = tree_.leaves[i];
      if (leaf.group != shape_linked_capsule) {
        row_of_[i] = static_cast<std::uint32_t>(std::min(rows_, max_rows(kind_bits_)));
        rows_ += rows_of(leaf.group);
        continue;
      }
      std::size_t block = tree_.order[leaf.first] - single_count(), f = 0;
      if (block >= linked_.by_form[0].blocks()) {
        f = 1;
        block -= linked_.by_form[0].blocks();
      }
      row_of_[i] =
          narrow<std::uint32_t>(base[f] + blocks[f].size() * linked_.by_form[f].rows_per_block());
      blocks[f].push_back(narrow<std::uint32_t>(block));
    }
    check_tree_limits(rows_, node_base_ + tree_.nodes.size(), kind_bits_);
    for (std::size_t f = 0; f < blocks.size(); ++f)
      reorder_blocks(leaves_.data() + base[f] * 8,
                     std::size_t{8} * linked_.by_form[f].rows_per_block(), blocks[f]);
  }

  EncodedTree described() const {
    EncodedTree out;
    out.root = narrow<std::uint32_t>(node_base_);
    out.nodes = tree_.nodes.size();
    out.depth = tree_.depth;
    out.sah = tree_.sah;
    std::fill(std::begin(out.min), std::end(out.min), inf);
    std::fill(std::begin(out.max), std::end(out.max), -inf);
    for (std::size_t k = 0; k < 3; k++)
      for (std::size_t i = 0; i < bvh::width; i++) {
        out.min[k] = std::min(out.min[k], tree_.nodes[0].min[k][i]);
        out.max[k] = std::max(out.max[k], tree_.nodes[0].max[k][i]);
      }
    return out;
  }

  void write_nodes(std::uint32_t root) {
    nodes_.resize(nodes_.size() + tree_.nodes.size() * CAPLET_NODE_FLOATS);
    tbb::parallel_for(std::size_t(0), tree_.nodes.size(), [&](std::size_t n) {
      const bvh::Node& from = tree_.nodes[n];
      float* to = &nodes_[(node_base_ + n) * CAPLET_NODE_FLOATS];
      for (std::size_t i = 0; i < bvh::width; i++) {
        for (std::size_t k = 0; k < 3; k++) {
          to[8 * k + i] = from.min[k][i];
          to[8 * (3 + k) + i] = from.max[k][i];
        }
        std::uint32_t child = static_cast<std::uint32_t>(from.child[i]);
        if (from.child[i] < 0) {
          const std::uint32_t leaf = ~child;
          child = 0x80000000u | (tree_.leaves[leaf].group << (31 - kind_bits_)) | row_of_[leaf];
        } else if (from.child[i] != 0x7fffffff) {
          child += root;
        }
        to[CAPLET_NODE_CHILDREN + i] = std::bit_cast<float>(child);
      }
    });
  }

  void write_primitives(std::vector<std::uint32_t>& slots) {
    leaves_.resize(rows_ * 8);
    slots.resize(primitives_.size());
    tbb::parallel_for(std::size_t(0), tree_.leaves.size(), [&](std::size_t l) {
      const bvh::Leaf& leaf = tree_.leaves[l];
      if (leaf.group == shape_linked_capsule) return;
      float* block = &leaves_[std::size_t(row_of_[l]) * 8];
      const std::uint32_t data_rows = data_of[leaf.group];
      for (std::uint32_t lane = 0; lane < 8; lane++) {
        // Empty lanes repeat the first primitive, so that no arithmetic meets odd values there.
        const std::size_t index = tree_.order[leaf.first + (lane < leaf.count ? lane : 0)];
        const FlatPrimitive p = single(index);
        block[lane] = std::bit_cast<float>(lane < leaf.count ? p.id : 0xffffffffu);
        for (std::uint32_t j = 0; j < data_rows; j++) block[8 * (j + 1) + lane] = p.data[j];
        if (lane < leaf.count && index < slots.size()) slots[index] = row_of_[l] * 8 + lane;
      }
    });
  }

  std::span<const FlatPrimitive> primitives_;
  const LooseCapsules& loose_;
  const TreeLinks& linked_;
  std::vector<float>&nodes_, &leaves_;
  int kind_bits_;
  std::uint64_t node_base_, row_base_;
  std::uint64_t rows_ = 0;  // of leaves_, that are in use
  bvh::Tree tree_;
  std::vector<std::uint32_t> row_of_;  // by leaf
};

}  // namespace

EncodedTree encode_tree(std::span<const FlatPrimitive> primitives, std::vector<float>& nodes,
                        std::vector<float>& leaves, int kind_bits) {
  return encode_tree({primitives, LooseCapsules(), TreeLinks()}, false, nodes, leaves, kind_bits);
}

EncodedTree encode_tree(const TreeItems& items, bool release, std::vector<float>& nodes,
                        std::vector<float>& leaves, int kind_bits) {
  return TreeEncoder(items, nodes, leaves, kind_bits).run(release);
}

}  // namespace caplet
