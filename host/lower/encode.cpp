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
#include "shared/kinds.h"

namespace caplet {
namespace {

static_assert(bvh::max_depth == CAPLET_TREE_DEPTH_MAX);
static_assert(bvh::width == CAPLET_WIDTH);
static_assert(shape_count <= 16, "a leaf reference has four bits for the shape");

constexpr std::array<std::uint32_t, shape_count> rows_of = {
#define SHAPE(name, rows) rows,
#include "shared/shapes.def"
#undef SHAPE
};

constexpr std::uint64_t max_rows = std::uint64_t(CAPLET_LEAF_ROW_MASK) + 1;
constexpr std::uint64_t max_nodes = std::uint64_t(1) << 31;
constexpr float inf = std::numeric_limits<float>::infinity();

/// Centre and half extent of the exact box, in double.
struct ExactBox {
  std::array<double, 3> min{}, max{};
};

ExactBox exact_box(const FlatPrimitive& p) {
  ExactBox box;
  for (std::size_t k = 0; k < 3; k++) {
    const double a = double(p.data[k]), b = double(p.data[3 + k]), c = double(p.data[6 + k]);
    switch (p.shape) {
      case shape_sphere:
        box.min[k] = a - double(p.data[3]);
        box.max[k] = a + double(p.data[3]);
        break;
      case shape_capsule:
      case shape_tapered_capsule: {
        const double r0 = double(p.data[6]), r1 = p.shape == shape_capsule ? r0 : double(p.data[7]);
        box.min[k] = std::min(a - r0, b - r1);
        box.max[k] = std::max(a + r0, b + r1);
        break;
      }
      case shape_triangle:
        box.min[k] = std::min({a, b, c});
        box.max[k] = std::max({a, b, c});
        break;
      case shape_disk: {
        const double across = double(p.data[6]) * std::sqrt(std::max(0.0, 1 - b * b));
        box.min[k] = a - across;
        box.max[k] = a + across;
        break;
      }
      case shape_cylinder:
      case shape_cone: {
        // A flat end is a disk across the axis.
        const bool cylinder = p.shape == shape_cylinder;
        const double axis[3] = {double(p.data[3]) - double(p.data[0]), double(p.data[4]) - double(p.data[1]),
                                double(p.data[5]) - double(p.data[2])};
        const double squared = axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2];
        const double across = squared > 0 ? std::sqrt(std::max(0.0, 1 - axis[k] * axis[k] / squared)) : 1;
        const double r0 = double(p.data[6]), r1 = cylinder ? r0 : double(p.data[7]);
        const double half0 = r0 * (p.data[cylinder ? 7 : 8] == CAPLET_CAP_ROUND ? 1 : across);
        const double half1 = r1 * (p.data[cylinder ? 8 : 9] == CAPLET_CAP_ROUND ? 1 : across);
        box.min[k] = std::min(a - half0, b - half1);
        box.max[k] = std::max(a + half0, b + half1);
        break;
      }
      case shape_polyhedron:
      case shape_csg:
        box.min[k] = b;
        box.max[k] = c;
        break;
      case shape_partial_sphere:
      case shape_open_cylinder:
        box.min[k] = k == 2 ? double(p.data[1]) : -double(p.data[0]);
        box.max[k] = k == 2 ? double(p.data[2]) : double(p.data[0]);
        break;
      case shape_partial_disk:
        box.min[k] = k == 2 ? double(p.data[0]) : -double(p.data[1]);
        box.max[k] = k == 2 ? double(p.data[0]) : double(p.data[1]);
        break;
      case shape_bilinear:
        box.min[k] = std::min({a, b, c, double(p.data[9 + k])});
        box.max[k] = std::max({a, b, c, double(p.data[9 + k])});
        break;
      default:
        box.min[k] = a;
        box.max[k] = b;
    }
  }
  return box;
}

/// The box of every point the shape kernels may report for rays from nearby: their error is at most 16 eps (size + coordinates),
/// eps = 2^-24, so 2^-20 of that is added, and the result rounded outward. The part that grows with the distance of a ray's
/// origin is the slab test's (kernels/trace/trace.cl).
bvh::Reference reference_of(const FlatPrimitive& p, std::uint32_t index) {
  const ExactBox box = exact_box(p);
  double reach = 0;
  for (std::size_t k = 0; k < 3; k++)
    reach = std::max({reach, std::abs(box.min[k]), std::abs(box.max[k]), 2 * (box.max[k] - box.min[k])});
  const double pad = reach * 0x1p-20;
  bvh::Reference r{};
  const double largest = double(std::numeric_limits<float>::max());
  for (std::size_t k = 0; k < 3; k++) {
    r.min[k] = std::nextafter(static_cast<float>(std::clamp(box.min[k] - pad, -largest, largest)), -inf);
    r.max[k] = std::nextafter(static_cast<float>(std::clamp(box.max[k] + pad, -largest, largest)), inf);
    r.min[k] = std::max(r.min[k], -std::numeric_limits<float>::max());
    r.max[k] = std::min(r.max[k], std::numeric_limits<float>::max());
  }
  r.primitive = index;
  r.group = p.shape;
  return r;
}

}  // namespace

std::uint64_t least_rows(std::span<const std::uint64_t> counts) {
  CHECK_EQ_(counts.size(), std::size_t(shape_count));
  std::uint64_t rows = 0;
  for (std::size_t s = 0; s < counts.size(); s++) rows += (counts[s] + 7) / 8 * rows_of[s];
  return rows;
}

void check_tree_limits(std::uint64_t rows, std::uint64_t nodes) {
  if (rows > max_rows)
    throw InputError(fmt::format("the scene needs {} rows of primitives, the layout holds {}: about {} million capsules", rows,
                                 max_rows, max_rows / 8 * 6 / 1000000));
  if (nodes > max_nodes) throw InputError(fmt::format("the scene needs {} tree nodes, the layout holds {}", nodes, max_nodes));
}

void primitive_box(const FlatPrimitive& p, double min[3], double max[3]) {
  const ExactBox box = exact_box(p);
  std::copy(box.min.begin(), box.min.end(), min);
  std::copy(box.max.begin(), box.max.end(), max);
}

EncodedTree encode_tree(std::span<const FlatPrimitive> primitives, std::vector<float>& nodes, std::vector<float>& leaves) {
  // Rows at the very least, before anything is allocated.
  const std::uint64_t node_base = nodes.size() / CAPLET_NODE_FLOATS, row_base = leaves.size() / 8;
  std::array<std::uint64_t, shape_count> counts{};
  for (const FlatPrimitive& p : primitives) {
    CHECK_LT_(p.shape, std::uint32_t(shape_count));
    counts[p.shape]++;
  }
  check_tree_limits(row_base + least_rows(counts), node_base + 1);

  std::vector<bvh::Reference> references(primitives.size());
  tbb::parallel_for(std::size_t(0), primitives.size(),
                    [&](std::size_t i) { references[i] = reference_of(primitives[i], static_cast<std::uint32_t>(i)); });
  const bvh::Tree tree = bvh::build(references, shape_instance);
  CHECK_LE_(tree.depth, bvh::max_depth);

  std::vector<std::uint32_t> row_of(tree.leaves.size());
  std::uint64_t rows = row_base;
  for (std::size_t i = 0; i < tree.leaves.size(); i++) {
    row_of[i] = static_cast<std::uint32_t>(std::min(rows, max_rows));
    rows += rows_of[tree.leaves[i].group];
  }
  check_tree_limits(rows, node_base + tree.nodes.size());

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
        child = 0x80000000u | (tree.leaves[leaf].group << CAPLET_LEAF_ROW_BITS) | row_of[leaf];
      } else if (from.child[i] != 0x7fffffff) {
        child += out.root;
      }
      to[48 + i] = std::bit_cast<float>(child);
    }
  });

  leaves.resize(rows * 8);
  out.slots.resize(primitives.size());
  tbb::parallel_for(std::size_t(0), tree.leaves.size(), [&](std::size_t l) {
    const bvh::Leaf& leaf = tree.leaves[l];
    float* block = &leaves[std::size_t(row_of[l]) * 8];
    const std::uint32_t data_rows = rows_of[leaf.group] - 1;
    for (std::uint32_t lane = 0; lane < 8; lane++) {
      // Empty lanes repeat the first primitive, so that no arithmetic meets odd values there.
      const std::uint32_t index = tree.order[leaf.first + (lane < leaf.count ? lane : 0)];
      const FlatPrimitive& p = primitives[index];
      block[lane] = std::bit_cast<float>(lane < leaf.count ? p.id : 0xffffffffu);
      for (std::uint32_t j = 0; j < data_rows; j++) block[8 * (j + 1) + lane] = p.data[j];
      if (lane < leaf.count) out.slots[index] = row_of[l] * 8 + lane;
    }
  });
  return out;
}

}  // namespace caplet
