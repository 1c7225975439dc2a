// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The tree: every reference in exactly one leaf, boxes contain, groups apart, independent of
// threads, bounded for bad input.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <limits>
#include <random>
#include <span>

#include "bvh/bvh.h"

namespace caplet::bvh {
namespace {

std::vector<Reference> random_boxes(std::size_t count, unsigned groups, float size) {
  std::mt19937 engine(1);
  std::uniform_real_distribution<float> u(-1, 1);
  std::vector<Reference> out(count);
  for (std::size_t i = 0; i < count; i++) {
    for (int k = 0; k < 3; k++) {
      out[i].min[k] = u(engine);
      out[i].max[k] = out[i].min[k] + size * (1 + u(engine));
    }
    out[i].primitive = 7;
    out[i].group = static_cast<std::uint32_t>(engine() % groups);
  }
  return out;
}

struct Census {
  const Tree& tree;
  std::span<const Reference> references;
  std::uint64_t single_groups;
  std::vector<int> seen;
  std::vector<bool> node_seen;
  int depth = 0;

  void visit(std::int32_t node, int level) {
    ASSERT_LT(static_cast<std::size_t>(node), tree.nodes.size());
    ASSERT_FALSE(node_seen[static_cast<std::size_t>(node)]);
    node_seen[static_cast<std::size_t>(node)] = true;
    depth = std::max(depth, level);
    const Node& n = tree.nodes[static_cast<std::size_t>(node)];
    for (int i = 0; i < width; i++) {
      if (n.child[i] == 0x7fffffff) {
        for (int k = 0; k < 3; k++) ASSERT_GT(n.min[k][i], n.max[k][i]);
        continue;
      }
      if (n.child[i] >= 0) {
        ASSERT_GT(n.child[i], node) << "children come after parents";
        const Node& inner = tree.nodes[static_cast<std::size_t>(n.child[i])];
        for (int j = 0; j < width; j++)
          for (int k = 0; k < 3; k++)
            if (inner.child[j] != 0x7fffffff) {
              ASSERT_LE(n.min[k][i], inner.min[k][j]);
              ASSERT_GE(n.max[k][i], inner.max[k][j]);
            }
        visit(n.child[i], level + 1);
        continue;
      }
      const Leaf& leaf = tree.leaves[static_cast<std::size_t>(~n.child[i])];
      ASSERT_GE(leaf.count, 1u);
      ASSERT_LE(leaf.count, (single_groups >> leaf.group & 1) != 0 ? 1u : 8u);
      for (std::uint32_t j = leaf.first; j < leaf.first + leaf.count; j++) {
        const Reference& r = references[tree.order[j]];
        seen[tree.order[j]]++;
        ASSERT_EQ(r.group, leaf.group);
        for (int k = 0; k < 3; k++) {
          ASSERT_LE(n.min[k][i], r.min[k]);
          ASSERT_GE(n.max[k][i], r.max[k]);
        }
      }
    }
  }
};

Tree check(std::span<const Reference> references, std::uint64_t single_groups = 0,
           Effort effort = Effort::full) {
  Tree tree = build({references.begin(), references.end()}, single_groups, effort);
  Census census{tree, references, single_groups, std::vector<int>(references.size(), 0),
                std::vector<bool>(tree.nodes.size(), false)};
  census.visit(0, 1);
  EXPECT_TRUE(std::all_of(census.seen.begin(), census.seen.end(), [](int n) { return n == 1; }));
  EXPECT_TRUE(
      std::all_of(census.node_seen.begin(), census.node_seen.end(), [](bool b) { return b; }));
  EXPECT_EQ(census.depth, tree.depth);
  EXPECT_LE(tree.depth, max_depth);
  return tree;
}

bool same(const Tree& a, const Tree& b) {
  const auto equal = [](const auto& x, const auto& y) {
    return x.size() == y.size() && std::memcmp(x.data(), y.data(), x.size() * sizeof(x[0])) == 0;
  };
  return equal(a.nodes, b.nodes) && equal(a.leaves, b.leaves) && equal(a.order, b.order);
}

TEST(Structure, EveryCountUpToAHundred) {
  for (std::size_t n = 1; n <= 100; n++) check(random_boxes(n, 1 + unsigned(n % 3), 0.1f));
}

TEST(Structure, ManyReferencesOfSeveralGroups) {
  const auto boxes = random_boxes(50000, 4, 0.02f);
  const Tree tree = check(boxes, 2);
  EXPECT_LE(tree.depth, 20);
}

TEST(Structure, OneReferenceIsARootWithALeaf) {
  const Tree tree = check(random_boxes(1, 1, 1));
  EXPECT_EQ(tree.nodes.size(), 1u);
  EXPECT_EQ(tree.leaves.size(), 1u);
}

TEST(Structure, NoReferencesAreARootWithoutChildren) {
  const Tree tree = check({});
  EXPECT_EQ(tree.nodes.size(), 1u);
  EXPECT_TRUE(tree.leaves.empty() && tree.order.empty());
  EXPECT_EQ(tree.sah, 0);
}

TEST(Structure, SameTreeForOneAndTwoThreads) {
  const auto boxes = random_boxes(150000, 2, 0.01f);
  Tree one, two;
  {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1);
    one = build(boxes);
  }
  {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 2);
    two = build(boxes);
  }
  EXPECT_TRUE(same(one, two));
}

TEST(Structure, SurfaceAreaCostBeatsSplittingByOrder) {
  const auto boxes = random_boxes(20000, 1, 0.01f);
  auto same_centre = boxes;  // the same boxes with no position to tell them apart would cost one
                             // visit of everything
  EXPECT_LT(check(boxes).sah, 0.01 * 20000 / 8);
  for (auto& r : same_centre)
    for (int k = 0; k < 3; k++) {
      const float half = 0.5f * (r.max[k] - r.min[k]);
      r.min[k] = -half;
      r.max[k] = half;
    }
  check(same_centre);
}

// From 65,536 references on, the upper levels go by the cells of a grid.
TEST(Structure, CellsFindNearlyTheTreeThatReferencesDo) {
  for (const float size : {0.001f, 0.02f, 0.3f}) {
    auto boxes = random_boxes(65536, 1, size);
    const double by_cells = check(boxes).sah;
    boxes.pop_back();
    const double by_references = check(boxes).sah;
    EXPECT_NEAR(by_cells / by_references, 1, 0.02) << size;
  }
}

TEST(Structure, QuickTreesAreNearlyAsGood) {
  for (const float size : {0.001f, 0.02f, 0.3f}) {
    auto boxes = random_boxes(200000, 1, size);
    const double quick = check(boxes, 0, Effort::quick).sah, full = check(boxes).sah;
    EXPECT_NEAR(quick / full, 1, 0.03) << size;
    boxes.resize(1000);
    EXPECT_TRUE(same(build(boxes), build(boxes, 0, Effort::quick)));
  }
}

TEST(Structure, CellsOfSeveralGroupsAndLeavesOfOne) { check(random_boxes(150000, 4, 0.02f), 2); }

TEST(Structure, CellsOfUnevenlySpreadReferences) {
  // Nine in ten within one cell of the grid that all of them make, some at one place, and all of
  // them on one line or in one plane.
  auto boxes = random_boxes(100000, 2, 0.001f);
  for (std::size_t i = 0; i < boxes.size(); i++) {
    const float scale = i % 10 == 0 ? 1.0f : i % 3 == 0 ? 0.0f : 1e-4f;
    for (int k = 0; k < 3; k++) {
      boxes[i].min[k] *= scale;
      boxes[i].max[k] *= scale;
    }
  }
  check(boxes);
  for (const int flat : {2, 1}) {
    for (auto& r : boxes) r.min[flat] = r.max[flat] = 0.5f;
    check(boxes);
  }
}

TEST(Structure, AllBoxesEqual) {
  std::vector<Reference> boxes(5000, Reference{{1, 2, 3}, 0, {4, 5, 6}, 0});
  const Tree tree = check(boxes);
  EXPECT_LE(tree.depth, 14);
}

TEST(Structure, PointsAtOnePlace) {
  check(std::vector<Reference>(3000, Reference{{1, 2, 3}, 0, {1, 2, 3}, 0}));
}

TEST(Structure, FlatAndThreadlikeSets) {
  auto boxes = random_boxes(3000, 1, 0.1f);
  for (auto& r : boxes) r.min[1] = r.max[1] = 0.25f;
  check(boxes);
  for (auto& r : boxes) r.min[2] = r.max[2] = -7;
  check(boxes);
}

TEST(Structure, HugeAndTinyCoordinates) {
  for (const float scale : {1e30f, 1.5e38f, 1e-30f, 1e-44f}) {
    auto boxes = random_boxes(3000, 1, 0.1f);
    for (auto& r : boxes)
      for (int k = 0; k < 3; k++) {
        r.min[k] *= scale;
        r.max[k] *= scale;
      }
    check(boxes);
  }
}

/// Each box twice as far as the last: a split by area peels off one at a time, without limit but
/// for the builder's.
TEST(Structure, ExponentialSpacingStaysWithinTheDepth) {
  std::vector<Reference> boxes;
  for (int i = 0; i < 20000; i++) {
    const float x = std::ldexp(1.0f, i % 240 - 120);
    boxes.push_back({{x, 0, 0}, 0, {x * 1.0001f, x, x}, static_cast<std::uint32_t>(i % 2)});
  }
  check(boxes);
}

}  // namespace
}  // namespace caplet::bvh
