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
#include "lower/detail/floats.h"
#include "lower/detail/shapes.h"
#include "lower/linking.h"

namespace caplet {
namespace {

static_assert(bvh::max_depth == CAPLET_TREE_DEPTH_MAX);
static_assert(bvh::width == CAPLET_WIDTH);
static_assert(shape_count <= 64, "sets of shapes, and six bits of leaf references, hold 64 kinds");

constexpr std::uint64_t max_rows(int kind_bits) { return std::uint64_t(1) << (31 - kind_bits); }
constexpr std::uint64_t max_nodes = std::uint64_t(1) << 31;

ExactBox kept_box(const FlatPrimitive& p) {
  ExactBox box;
  std::copy_n(p.kept_box(), 3, box.min.begin());
  std::copy_n(p.kept_box() + 3, 3, box.max.begin());
  return box;
}

ExactBox exact_box(const FlatPrimitive& p) {
  switch (p.shape) {
#define SHAPE(name, traits)                                             \
  case shape_##name:                                                    \
    if constexpr (((traits)&trait_kept_box) == 0) return name##_box(p); \
    break;
#define COMPOUND(name, traits)
#include "shared/shapes.def"
#undef SHAPE
    default:
      break;
  }
  return kept_box(p);
}

/// LeafItems are what the tree is built over: primitives, and leaf blocks of linked capsules, which
/// are several of them in a row.
class LeafItems {
 public:
  LeafItems(std::span<const FlatPrimitive> primitives, bool any_linked) : primitives_(primitives) {
    if (!any_linked) return;
    for (std::size_t first = 0, end = 0; first < primitives.size(); first = end) {
      end = first + 1;
      while (end < primitives.size() && are_linked(primitives[end - 1], primitives[end])) ++end;
      // Blocks of equal length have smaller boxes than full ones and a rest.
      const std::size_t blocks = (end - first + CAPLET_WIDTH - 1) / CAPLET_WIDTH;
      for (std::size_t b = 0; b < blocks; ++b)
        begins_.push_back(narrow<std::uint32_t>(first + (end - first) * b / blocks));
    }
    begins_.push_back(narrow<std::uint32_t>(primitives.size()));
  }

  std::size_t size() const { return begins_.empty() ? primitives_.size() : begins_.size() - 1; }
  std::size_t begin(std::size_t item) const { return begins_.empty() ? item : begins_[item]; }
  std::span<const FlatPrimitive> operator[](std::size_t item) const {
    return primitives_.subspan(begin(item), begin(item + 1) - begin(item));
  }

  bvh::Reference reference(std::size_t item) const {
    const std::span<const FlatPrimitive> of = (*this)[item];
    bvh::Reference r{};
    std::fill_n(r.min, 3, inf);
    std::fill_n(r.max, 3, -inf);
    for (const FlatPrimitive& p : of) {
      const ReferenceBox box = reference_box(p);
      for (int k = 0; k < 3; ++k) {
        r.min[k] = std::min(r.min[k], box.min[k]);
        r.max[k] = std::max(r.max[k], box.max[k]);
      }
    }
    r.primitive = narrow<std::uint32_t>(item);
    r.group = of[0].shape;
    return r;
  }

 private:
  std::span<const FlatPrimitive> primitives_;
  std::vector<std::uint32_t> begins_;  // of each item, and the end; empty: each is a primitive
};

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

// The kernels' error is at most 16 eps (size + coordinates) for rays from nearby, eps = 2^-24, so
// 2^-20 of that is added. The slab test covers the part that grows with the distance of a ray's
// origin (kernels/trace/trace.cl).
ReferenceBox reference_box(const FlatPrimitive& p) {
  const ExactBox box = exact_box(p);
  double reach = 0;
  for (std::size_t k = 0; k < 3; k++)
    reach = std::max(
        {reach, std::abs(box.min[k]), std::abs(box.max[k]), 2 * (box.max[k] - box.min[k])});
  const double pad = reach * 0x1p-20;
  ReferenceBox r{};
  const double largest = double(std::numeric_limits<float>::max());
  for (std::size_t k = 0; k < 3; k++) {
    r.min[k] = next_down(static_cast<float>(std::clamp(box.min[k] - pad, -largest, largest)));
    r.max[k] = next_up(static_cast<float>(std::clamp(box.max[k] + pad, -largest, largest)));
    r.min[k] = std::max(r.min[k], -std::numeric_limits<float>::max());
    r.max[k] = std::min(r.max[k], std::numeric_limits<float>::max());
  }
  return r;
}

void primitive_box(const FlatPrimitive& p, double min[3], double max[3]) {
  const ExactBox box = exact_box(p);
  std::copy(box.min.begin(), box.min.end(), min);
  std::copy(box.max.begin(), box.max.end(), max);
}

EncodedTree encode_tree(std::span<const FlatPrimitive> primitives, std::vector<float>& nodes,
                        std::vector<float>& leaves, int kind_bits) {
  // These are the least numbers of rows, before anything is allocated.
  const std::uint64_t node_base = nodes.size() / CAPLET_NODE_FLOATS, row_base = leaves.size() / 8;
  std::array<std::uint64_t, shape_count> counts{};
  for (const FlatPrimitive& p : primitives) {
    CHECK_LT_(p.shape, std::uint32_t(shape_count));
    CHECK_LT_(p.shape >> kind_bits, 1u);
    counts[p.shape]++;
  }
  check_tree_limits(row_base + least_rows(counts), node_base + 1, kind_bits);

  const LeafItems items(primitives, counts[shape_linked_capsule] > 0);
  bvh::Tree tree;
  {
    std::vector<bvh::Reference> references(items.size());
    tbb::parallel_for(std::size_t(0), items.size(),
                      [&](std::size_t i) { references[i] = items.reference(i); });
    tree = bvh::build(references, shape_bit(shape_instance) | shape_bit(shape_linked_capsule));
  }
  CHECK_LE_(tree.depth, bvh::max_depth);

  std::vector<std::uint32_t> row_of(tree.leaves.size());
  std::uint64_t rows = row_base;
  for (std::size_t i = 0; i < tree.leaves.size(); i++) {
    row_of[i] = static_cast<std::uint32_t>(std::min(rows, max_rows(kind_bits)));
    rows += tree.leaves[i].group == shape_linked_capsule
                ? link_rows(items[tree.order[tree.leaves[i].first]][0])
                : rows_of(tree.leaves[i].group);
  }
  check_tree_limits(rows, node_base + tree.nodes.size(), kind_bits);

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

  leaves.resize(rows * 8);
  out.slots.resize(primitives.size());
  tbb::parallel_for(std::size_t(0), tree.leaves.size(), [&](std::size_t l) {
    const bvh::Leaf& leaf = tree.leaves[l];
    float* block = &leaves[std::size_t(row_of[l]) * 8];
    if (leaf.group == shape_linked_capsule) {
      const std::size_t item = tree.order[leaf.first];
      write_links(items[item], block);
      for (std::size_t i = 0; i < items[item].size(); ++i)
        out.slots[items.begin(item) + i] =
            CAPLET_SLOT_LINKED | (row_of[l] * 8 + static_cast<std::uint32_t>(i));
      return;
    }
    const std::uint32_t data_rows = data_of[leaf.group];
    for (std::uint32_t lane = 0; lane < 8; lane++) {
      // Empty lanes repeat the first primitive, so that no arithmetic meets odd values there.
      const std::size_t index =
          items.begin(tree.order[leaf.first + (lane < leaf.count ? lane : 0)]);
      const FlatPrimitive& p = primitives[index];
      block[lane] = std::bit_cast<float>(lane < leaf.count ? p.id : 0xffffffffu);
      for (std::uint32_t j = 0; j < data_rows; j++) block[8 * (j + 1) + lane] = p.data[j];
      if (lane < leaf.count) out.slots[index] = row_of[l] * 8 + lane;
    }
  });
  return out;
}

}  // namespace caplet
