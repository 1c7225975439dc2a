// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The flat arrays: slots lead back to the data given, boxes hold the primitives with room to spare,
// limits are errors.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <iterator>
#include <random>
#include <utility>

#include "base/error.h"
#include "lower/encode.h"
#include "lower/lower.h"
#include "scene/scene.h"
#include "shared/shapes.h"

namespace caplet {
namespace {

// The ids, then the data: a sphere's centre and radius, a capsule's ends and radius ... Linked
// capsules (0) have blocks of another form: tests/links.
constexpr std::uint32_t rows_by_count[] = {1 + 4,  1 + 7, 1 + 8, 0,     1 + 9, 1 + 7, 1 + 9,
                                           1 + 10, 1 + 6, 1 + 1, 1 + 4, 1 + 4, 1 + 4, 1 + 12,
                                           1 + 1,  1 + 3, 1 + 4, 1,     1 + 5};
static_assert(std::size(rows_by_count) == shape_count);

std::vector<FlatPrimitive> mixed(unsigned count) {
  std::mt19937 engine(3);
  std::uniform_real_distribution<float> u(0.1f, 1);
  std::vector<FlatPrimitive> out;
  for (unsigned i = 0; i < count; i++) {
    FlatPrimitive p{i % shape_instance, 1000 + i, {}};
    if (shape_has(p.shape, trait_linked)) continue;
    for (float& x : p.data) x = u(engine);
    if (p.shape == shape_disk)
      std::copy_n(std::array{0.0f, 0.0f, 1.0f}.data(), 3, p.data + disk_at_n);
    out.push_back(p);
  }
  return out;
}

TEST(Encode, SlotsLeadToTheDataGiven) {
  const auto primitives = mixed(1003);
  std::vector<float> nodes, leaves(16, 5.0f);  // something is there already
  const EncodedTree tree = encode_tree(primitives, nodes, leaves);
  ASSERT_EQ(tree.slots.size(), primitives.size());
  EXPECT_EQ(leaves[3], 5.0f);
  for (std::size_t i = 0; i < primitives.size(); i++) {
    const std::uint32_t slot = tree.slots[i];
    ASSERT_GE(slot, 16u);
    EXPECT_EQ(primitive_at(leaves, slot), primitives[i].id);
    for (std::uint32_t j = 1; j < rows_by_count[primitives[i].shape]; j++)
      EXPECT_EQ(leaves[slot + 8 * j], primitives[i].data[j - 1])
          << "shape " << primitives[i].shape << " row " << j;
  }
}

TEST(Encode, SecondTreeRefersToItsOwnNodes) {
  const auto primitives = mixed(300);
  std::vector<float> nodes, leaves;
  const EncodedTree first = encode_tree(primitives, nodes, leaves);
  const std::size_t first_floats = nodes.size();
  const EncodedTree second = encode_tree(primitives, nodes, leaves);
  EXPECT_EQ(first.root, 0u);
  EXPECT_EQ(second.root * CAPLET_NODE_FLOATS, first_floats);
  for (std::size_t n = second.root; n < nodes.size() / CAPLET_NODE_FLOATS; n++)
    for (std::size_t i = 0; i < CAPLET_WIDTH; i++) {
      const auto child = std::bit_cast<std::int32_t>(nodes[n * CAPLET_NODE_FLOATS + 48 + i]);
      if (child >= 0 && child != 0x7fffffff) {
        EXPECT_GT(static_cast<std::size_t>(child), n);
      }
      if (child < 0) {
        EXPECT_GE(std::uint32_t(child) & ((1u << CAPLET_LEAF_ROW_BITS) - 1), leaves.size() / 16);
      }
    }
  EXPECT_EQ(second.depth, first.depth);
}

TEST(Encode, InstancesGetALeafEach) {
  std::vector<FlatPrimitive> primitives;
  for (std::uint32_t i = 0; i < 20; i++) {
    const float x = static_cast<float>(i);
    primitives.push_back({shape_instance, i, {x, 0, 0, x + 0.5f, 1, 1, 0, 0, 0}});
  }
  std::vector<float> nodes, leaves;
  const EncodedTree tree = encode_tree(primitives, nodes, leaves);
  for (const std::uint32_t slot : tree.slots) EXPECT_EQ(slot % 8, 0u);
}

/// Points of the surfaces, pushed out by the error the kernels claim for rays from nearby, are
/// inside the boxes.
TEST(Encode, BoxesHoldWhatTheKernelsMayReport) {
  std::mt19937 engine(5);
  std::uniform_real_distribution<float> u(-1, 1);
  for (const float shift : {0.0f, 1e5f}) {
    for (int i = 0; i < 500; i++) {
      FlatPrimitive p{shape_capsule, 0, {}};
      for (int k = 0; k < 6; k++) p.data[k] = u(engine) + shift;
      p.data[6] = 0.1f * (1.01f + u(engine));
      std::vector<float> nodes, leaves;
      const EncodedTree tree = encode_tree(std::vector<FlatPrimitive>{p}, nodes, leaves);
      for (int k = 0; k < 3; k++) {
        const double low = std::min(double(p.data[k]), double(p.data[3 + k])) - double(p.data[6]);
        const double high = std::max(double(p.data[k]), double(p.data[3 + k])) + double(p.data[6]);
        const double error = 16 * 0x1p-24 * (high - low);
        EXPECT_LE(double(tree.min[k]), low - error);
        EXPECT_GE(double(tree.max[k]), high + error);
        EXPECT_LT(double(tree.max[k]) - high,
                  1e-5 * (std::abs(double(shift)) + 8));  // and not much larger
      }
    }
  }
}

TEST(Encode, LimitsOfTheLayout) {
  constexpr std::uint64_t most_rows = std::uint64_t(1) << 27, most_nodes = std::uint64_t(1) << 31;
  EXPECT_NO_THROW(check_tree_limits(most_rows, most_nodes, 4));
  EXPECT_THROW(check_tree_limits(most_rows + 1, 0, 4), InputError);
  EXPECT_THROW(check_tree_limits(0, most_nodes + 1, 4), InputError);
  // Two bits more for the kind are two less for the row.
  EXPECT_NO_THROW(check_tree_limits(most_rows / 4, 0, 6));
  EXPECT_THROW(check_tree_limits(most_rows / 4 + 1, 0, 6), InputError);
  // A hundred million capsules fit, eight to a leaf of eight rows.
  std::array<std::uint64_t, shape_count> counts{};
  counts[shape_capsule] = 100'000'000;
  EXPECT_LT(least_rows(counts), most_rows);
  counts[shape_capsule] = std::uint64_t(-8) / 16;  // nothing overflows
  EXPECT_THROW(check_tree_limits(least_rows(counts), 0, 4), InputError);
}

TEST(Encode, BitsOfAKind) {
  EXPECT_EQ(leaf_kind_bits(0), 4);
  for (const auto& [kind, bits] : {std::pair(15, 4), {16, 5}, {31, 5}, {32, 6}, {63, 6}}) {
    EXPECT_EQ(leaf_kind_bits(std::uint64_t{1} << kind), bits) << kind;
    EXPECT_EQ(leaf_kind_bits(std::uint64_t{1} << kind | 1), bits) << kind;
  }
}

// Nothing is made of them: 110 million triangles as FlatPrimitives would be 6 GB.
TEST(Encode, TooManyPrimitivesAreRefusedBeforeMemoryIsAllocated) {
  Scene scene;
  scene.materials.push_back({DiffuseMaterial{}, "", {}});
  TriangleMeshShape mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {}, {}, {}};
  mesh.triangles.resize(110'000'000, {0, 1, 2});
  scene.shapes.emplace_back().geometry = std::move(mesh);
  rusage before{}, after{};
  getrusage(RUSAGE_SELF, &before);
  EXPECT_THROW(lower(scene), InputError);
  getrusage(RUSAGE_SELF, &after);
  EXPECT_LT(after.ru_maxrss - before.ru_maxrss, 100'000);  // KiB
}

}  // namespace
}  // namespace caplet
