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

static_assert(bvh::max_depth == CAPLET_TREE_DEPTH_MAX);
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

}  // namespace

EncodedTree encode_tree(std::span<const FlatPrimitive> primitives, std::vector<float>& nodes,
                        std::vector<float>& leaves, int kind_bits) {
  return encode_tree(primitives, TreeLinks(), false, nodes, leaves, kind_bits);
}

EncodedTree encode_tree(std::span<const FlatPrimitive> primitives, const TreeLinks& linked,
                        bool release, std::vector<float>& nodes, std::vector<float>& leaves,
                        int kind_bits) {
  // These are the least numbers of rows, before anything is allocated.
  const std::uint64_t node_base = nodes.size() / CAPLET_NODE_FLOATS, row_base = leaves.size() / 8;
  std::array<std::uint64_t, shape_count> counts{};
  for (const FlatPrimitive& p : primitives) {
    CHECK_LT_(p.shape, std::uint32_t(shape_count));
    CHECK_LT_(p.shape >> kind_bits, 1u);
    CHECK_EQ_(shape_has(p.shape, trait_linked), false);
    counts[p.shape]++;
  }
  std::uint64_t rows = row_base;
  std::size_t items = primitives.size();
  for (const LinkedCapsules& form : linked.by_form) {
    rows += std::uint64_t{form.blocks()} * form.rows_per_block();
    items += form.blocks();
  }
  check_tree_limits(rows + least_rows(counts), node_base + 1, kind_bits);

  // Blocks of linked capsules come first. They are written in the order of their shapes, whose
  // memory may be given back so, before the tree says which follows which.
  if (rows > row_base) leaves.reserve((rows + least_rows(counts) * 3 / 2) * 8);
  leaves.resize(row_base * 8);
  bvh::Tree tree;
  {
    std::vector<bvh::Reference> references(items);
    const auto set = [&](std::size_t i, const ReferenceBox& box, std::uint32_t group) {
      bvh::Reference& to = references[i];
      std::copy_n(box.min, 3, to.min);
      std::copy_n(box.max, 3, to.max);
      to.primitive = narrow<std::uint32_t>(i);
      to.group = group;
    };
    tbb::parallel_for(std::size_t(0), primitives.size(), [&](std::size_t i) {
      set(i, reference_box(primitives[i]), primitives[i].shape);
    });
    std::size_t item = primitives.size();
    for (const LinkedCapsules& form : linked.by_form) {
      form.append(
          leaves,
          [&](std::size_t block, const ReferenceBox& box) {
            set(item + block, box, shape_linked_capsule);
          },
          release);
      item += form.blocks();
    }
    tree = bvh::build(std::move(references),
                      shape_bit(shape_instance) | shape_bit(shape_linked_capsule));
  }
  CHECK_LE_(tree.depth, bvh::max_depth);

  std::vector<std::uint32_t> row_of(tree.leaves.size());
  std::array<std::vector<std::uint32_t>, 2> blocks;  // in the tree's order
  for (std::size_t f = 0; f < blocks.size(); ++f) blocks[f].reserve(linked.by_form[f].blocks());
  for (std::size_t i = 0; i < tree.leaves.size(); i++) {
    const bvh::Leaf& leaf = tree.leaves[i];
    if (leaf.group != shape_linked_capsule) {
      row_of[i] = static_cast<std::uint32_t>(std::min(rows, max_rows(kind_bits)));
      rows += rows_of(leaf.group);
      continue;
    }
    std::size_t form = 0, block = tree.order[leaf.first] - primitives.size(), row = row_base;
    if (block >= linked.by_form[0].blocks()) {
      form = 1;
      block -= linked.by_form[0].blocks();
      row += linked.by_form[0].blocks() * linked.by_form[0].rows_per_block();
    }
    row_of[i] =
        narrow<std::uint32_t>(row + blocks[form].size() * linked.by_form[form].rows_per_block());
    blocks[form].push_back(narrow<std::uint32_t>(block));
  }
  check_tree_limits(rows, node_base + tree.nodes.size(), kind_bits);
  {
    float* at = leaves.data() + row_base * 8;
    for (std::size_t f = 0; f < blocks.size(); ++f) {
      const std::size_t floats = std::size_t{8} * linked.by_form[f].rows_per_block();
      reorder_blocks(at, floats, blocks[f]);
      at += floats * blocks[f].size();
    }
  }

  EncodedTree out;
  out.root = narrow<std::uint32_t>(node_base);
  out.nodes = tree.nodes.size();
  out.depth = tree.depth;
  out.sah = tree.sah;
  std::fill(std::begin(out.min), std::end(out.min), inf);
  std::fill(std::begin(out.max), std::end(out.max), -inf);
  for (std::size_t k = 0; k < 3; k++)
    for (std::size_t i = 0; i < bvh::width; i++) {
      out.min[k] = std::min(out.min[k], tree.nodes[0].min[k][i]);
      out.max[k] = std::max(out.max[k], tree.nodes[0].max[k][i]);
    }

  nodes.resize(nodes.size() + tree.nodes.size() * CAPLET_NODE_FLOATS);
  tbb::parallel_for(std::size_t(0), tree.nodes.size(), [&](std::size_t n) {
    const bvh::Node& from = tree.nodes[n];
    float* to = &nodes[(node_base + n) * CAPLET_NODE_FLOATS];
    for (std::size_t i = 0; i < bvh::width; i++) {
      for (std::size_t k = 0; k < 3; k++) {
        to[8 * k + i] = from.min[k][i];
        to[8 * (3 + k) + i] = from.max[k][i];
      }
      std::uint32_t child = static_cast<std::uint32_t>(from.child[i]);
      if (from.child[i] < 0) {
        const std::uint32_t leaf = ~child;
        child = 0x80000000u | (tree.leaves[leaf].group << (31 - kind_bits)) | row_of[leaf];
      } else if (from.child[i] != 0x7fffffff) {
        child += out.root;
      }
      to[CAPLET_NODE_CHILDREN + i] = std::bit_cast<float>(child);
    }
  });

  tree.nodes = {};

  leaves.resize(rows * 8);
  out.slots.resize(primitives.size());
  tbb::parallel_for(std::size_t(0), tree.leaves.size(), [&](std::size_t l) {
    const bvh::Leaf& leaf = tree.leaves[l];
    float* block = &leaves[std::size_t(row_of[l]) * 8];
    if (leaf.group == shape_linked_capsule) return;
    const std::uint32_t data_rows = data_of[leaf.group];
    for (std::uint32_t lane = 0; lane < 8; lane++) {
      // Empty lanes repeat the first primitive, so that no arithmetic meets odd values there.
      const std::size_t index = tree.order[leaf.first + (lane < leaf.count ? lane : 0)];
      const FlatPrimitive& p = primitives[index];
      block[lane] = std::bit_cast<float>(lane < leaf.count ? p.id : 0xffffffffu);
      for (std::uint32_t j = 0; j < data_rows; j++) block[8 * (j + 1) + lane] = p.data[j];
      if (lane < leaf.count) out.slots[index] = row_of[l] * 8 + lane;
    }
  });
  return out;
}

}  // namespace caplet
