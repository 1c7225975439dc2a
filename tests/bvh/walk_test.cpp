// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// One ray at a time finds what is found eight boxes at a time, to the bit, however short its stack
// is and however deep the trees.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <vector>

#include "device_tracer.h"
#include "random_scene.h"
#include "support/test_device.h"

namespace caplet::test {
namespace {

/// 0: as long as it is in a render.
class Walk : public testing::TestWithParam<int> {
 protected:
  DeviceTracer one_{test_device(), 1,
                    GetParam() == 0 ? "" : fmt::format("-DCAPLET_STACK_SIZE={}", GetParam())};
  DeviceTracer wide_{test_device(), 8, "", {}, DeviceTracer::Manner::one_by_one};

  /// The hits, which are the same in both.
  std::vector<HitRecord> trace(const Encoded& scene, const std::vector<InstanceRecord>& instances,
                               std::uint32_t root, const std::vector<RayRecord>& rays) {
    for (DeviceTracer* tracer : {&one_, &wide_})
      tracer->upload(scene.nodes, scene.leaves, instances, root);
    return same_hits(one_, wide_, rays);
  }
};
INSTANTIATE_TEST_SUITE_P(Stacks, Walk, testing::Values(0, 1, 2, 4));

TEST_P(Walk, RandomScenes) {
  for (const unsigned kind :
       {unsigned(shape_capsule), unsigned(shape_triangle), unsigned(shape_instance)}) {
    const Encoded scene = encode(random_scene(61 + kind, kind, 3000, 0.2f));
    trace(scene, {}, scene.tree.root, random_rays(62, 5000));
  }
}

struct Ball {
  float x[3], r;
  std::uint32_t slot;
};

/// A tree of `levels` nodes, each in slot `way` of the one above it, and the other seven children
/// of each a ball; `tail` is in that slot of the last. Every box is met, so nothing but the order
/// of slots decides what comes first.
std::uint32_t add_chain(Random& random, std::uint32_t way, std::uint32_t levels, std::uint32_t tail,
                        Encoded& scene, std::vector<Ball>& balls) {
  const auto root = static_cast<std::uint32_t>(scene.nodes.size() / CAPLET_NODE_FLOATS);
  for (std::uint32_t level = 0; level < levels; ++level) {
    const std::size_t at = scene.nodes.size();
    scene.nodes.resize(at + CAPLET_NODE_FLOATS);
    for (std::uint32_t i = 0; i < 8; ++i) {
      std::uint32_t child = level + 1 < levels ? root + level + 1 : tail;
      if (i != way) {
        const auto row = static_cast<std::uint32_t>(scene.leaves.size() / 8);
        child = 0x80000000u | std::uint32_t{shape_sphere} << CAPLET_LEAF_ROW_BITS | row;
        const Ball ball{
            {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)}, 0.01f, row * 8};
        const float data[] = {ball.x[0], ball.x[1], ball.x[2], ball.r};
        for (std::uint32_t lane = 0; lane < 8; ++lane)
          scene.leaves.push_back(std::bit_cast<float>(
              lane == 0 ? static_cast<std::uint32_t>(balls.size()) : CAPLET_NONE));
        for (const float x : data) scene.leaves.insert(scene.leaves.end(), 8, x);
        balls.push_back(ball);
      }
      for (std::uint32_t k = 0; k < 3; ++k) {
        scene.nodes[at + 8 * k + i] = -1.25f;
        scene.nodes[at + 24 + 8 * k + i] = 1.25f;
      }
      scene.nodes[at + 48 + i] = std::bit_cast<float>(child);
    }
  }
  return root;
}

/// Rays at each ball, from each octant.
std::vector<RayRecord> rays_at(Random& random, const std::vector<Ball>& balls) {
  std::vector<RayRecord> rays;
  for (const Ball& ball : balls)
    for (std::uint32_t octant = 0; octant < 8; ++octant) {
      float d[3];
      for (std::uint32_t k = 0; k < 3; ++k)
        d[k] = random.uniform(0.2f, 1) * (octant >> k & 1 ? -1.0f : 1.0f);
      rays.push_back({ball.x[0] - 4 * d[0], ball.x[1] - 4 * d[1], ball.x[2] - 4 * d[2], 0, d[0],
                      d[1], d[2], INFINITY});
    }
  return rays;
}

TEST_P(Walk, TreesDeeperThanTheStack) {
  for (const std::uint32_t way : {0u, 5u, 7u}) {
    Random random(63 + way);
    Encoded scene;
    std::vector<Ball> balls;
    // The last node's own child on the way is a ball too.
    scene.leaves.assign(8, std::bit_cast<float>(CAPLET_NONE));
    scene.leaves[0] = std::bit_cast<float>(0xffffu);
    for (const float x : {5.0f, 5.0f, 5.0f, 0.01f}) scene.leaves.insert(scene.leaves.end(), 8, x);
    const std::uint32_t tail = 0x80000000u | std::uint32_t{shape_sphere} << CAPLET_LEAF_ROW_BITS;
    const std::uint32_t root = add_chain(random, way, CAPLET_TREE_DEPTH_MAX, tail, scene, balls);
    const auto rays = rays_at(random, balls);
    const auto hits = trace(scene, {}, root, rays);
    std::size_t found = 0;
    for (std::size_t i = 0; i < rays.size(); ++i)
      found += hits[i].slot == balls[i / 8].slot ? 1 : 0;
    // Few are behind another.
    EXPECT_GT(found, rays.size() * 9 / 10);
  }
}

TEST_P(Walk, DeepTreesOfInstances) {
  for (const std::uint32_t way : {0u, 6u}) {
    Random random(71 + way);
    Encoded scene;
    std::vector<Ball> inner, outer;
    // Row 0: a leaf of instance 0, row 1 of instance 1.
    for (const std::uint32_t instance : {0u, 1u}) {
      scene.leaves.push_back(std::bit_cast<float>(instance));
      scene.leaves.insert(scene.leaves.end(), 7, std::bit_cast<float>(CAPLET_NONE));
    }
    const auto leaf_of = [](std::uint32_t row) {
      return 0x80000000u | std::uint32_t{shape_instance} << CAPLET_LEAF_ROW_BITS | row;
    };
    // An object's tree ends in a ball far away.
    const auto far_row = static_cast<std::uint32_t>(scene.leaves.size() / 8);
    scene.leaves.insert(scene.leaves.end(), 8, std::bit_cast<float>(CAPLET_NONE));
    scene.leaves[8 * std::size_t{far_row}] = std::bit_cast<float>(0xffffu);
    for (const float x : {5.0f, 5.0f, 5.0f, 0.01f}) scene.leaves.insert(scene.leaves.end(), 8, x);
    const std::uint32_t object = add_chain(
        random, way, CAPLET_TREE_DEPTH_MAX,
        0x80000000u | std::uint32_t{shape_sphere} << CAPLET_LEAF_ROW_BITS | far_row, scene, inner);
    const std::uint32_t root =
        add_chain(random, way, CAPLET_TREE_DEPTH_MAX, leaf_of(0), scene, outer);
    // A second instance beside a ball of the first node, so that the way leads out of one, on, and
    // into the other.
    const std::uint32_t beside = way == 0 ? 7 : 0;
    scene.nodes[std::size_t{root} * CAPLET_NODE_FLOATS + 48 + beside] =
        std::bit_cast<float>(leaf_of(1));
    std::vector<InstanceRecord> instances(2);
    for (std::uint32_t n = 0; n < 2; ++n) {
      const float shift = n == 0 ? 0.0f : 0.125f;
      for (std::uint32_t k = 0; k < 3; ++k) {
        instances[n].object_from_world[5 * k] = instances[n].world_from_object[5 * k] = 1;
        instances[n].object_from_world[4 * k + 3] = -shift;
        instances[n].world_from_object[4 * k + 3] = shift;
      }
      instances[n].root = object;
      instances[n].object = 100 + n;
    }
    std::vector<Ball> all = outer;
    all.insert(all.end(), inner.begin(), inner.end());
    for (Ball ball : inner) {
      for (float& x : ball.x) x += 0.125f;
      all.push_back(ball);
    }
    const auto rays = rays_at(random, all);
    const auto hits = trace(scene, instances, root, rays);
    std::size_t found = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) found += hits[i].slot == all[i / 8].slot ? 1 : 0;
    EXPECT_GT(found, rays.size() * 8 / 10);
  }
}

}  // namespace
}  // namespace caplet::test
