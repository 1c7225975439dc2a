// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Trees of what moves: each is for a part of the time that the shutter is open, and its boxes hold
// what is there then.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <functional>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "frozen_hits.h"
#include "lower/lower.h"
#include "render_scene.h"
#include "scene/shapes/capsule_motion.h"
#include "scene/shapes/mesh_motion.h"
#include "shared/shapes.h"

namespace caplet::test::intervals_test {
namespace {

using glm::vec3;

struct Box {
  std::array<float, 3> min, max;
  bool holds(const vec3& p, float radius) const {
    for (int k = 0; k < 3; ++k) {
      const auto axis = static_cast<std::size_t>(k);
      if (!(min[axis] <= p[k] - radius && p[k] + radius <= max[axis])) return false;
    }
    return true;
  }
};

/// Calls found(kind, id, boxes) for each primitive under a node, with the boxes on the way to it.
using Found = std::function<void(std::uint32_t, std::uint32_t, const std::vector<Box>&)>;
void visit(const FlatScene& flat, std::uint32_t node, std::vector<Box>& boxes, const Found& found) {
  const float* at = &flat.nodes[std::size_t{node} * CAPLET_NODE_FLOATS];
  for (std::size_t i = 0; i < 8; ++i) {
    const auto child = std::bit_cast<std::uint32_t>(at[CAPLET_NODE_CHILDREN + i]);
    if (child == 0x7fffffffu) continue;
    boxes.push_back({{at[i], at[8 + i], at[16 + i]}, {at[24 + i], at[32 + i], at[40 + i]}});
    if ((child >> 31) == 0) {
      visit(flat, child, boxes, found);
    } else {
      const int bits = flat.leaf_kind_bits;
      const std::uint32_t kind = child >> (31 - bits) & ((1u << bits) - 1),
                          row = child & ((1u << (31 - bits)) - 1);
      for (std::size_t lane = 0; lane < 8; ++lane) {
        const auto id = std::bit_cast<std::uint32_t>(flat.leaves[std::size_t{row} * 8 + lane]);
        const bool is_there = kind == shape_instance ? lane == 0 : id != CAPLET_NONE;
        if (is_there) found(kind, id, boxes);
      }
    }
    boxes.pop_back();
  }
}

std::vector<std::uint32_t> roots_of(const FlatScene& flat, std::uint32_t root,
                                    std::uint32_t intervals, std::uint32_t begin) {
  std::vector<std::uint32_t> out;
  for (std::uint32_t i = 0; i < intervals; ++i)
    out.push_back(std::bit_cast<std::uint32_t>(flat.leaves[begin + i]));
  if (out.empty()) out.push_back(root);
  return out;
}
std::vector<std::uint32_t> roots_of(const FlatScene& flat) {
  return roots_of(flat, flat.world.root, flat.world.intervals, flat.world.roots);
}

Box bounds_of_tree(const FlatScene& flat, std::uint32_t root) {
  const float* at = &flat.nodes[std::size_t{root} * CAPLET_NODE_FLOATS];
  Box out;
  for (std::size_t k = 0; k < 3; ++k) {
    out.min[k] = *std::min_element(at + 8 * k, at + 8 * k + 8);
    out.max[k] = *std::max_element(at + 24 + 8 * k, at + 32 + 8 * k);
  }
  return out;
}

/// Capsules that go far: `reach` at each of the times.
CapsulesShape far_capsules(std::size_t count, const std::vector<double>& times, float reach,
                           unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> unit(-1, 1);
  const auto any = [&] { return vec3(unit(random), unit(random), unit(random)); };
  CapsulesShape out;
  out.times = times;
  for (std::size_t key = 0; key < times.size(); ++key)
    for (std::size_t i = 0; i < count; ++i) {
      out.p0.push_back(reach * any());
      out.p1.push_back(out.p0.back() + 0.4f * any());
      out.radius0.push_back(0.05f + 0.1f * std::abs(unit(random)));
      out.radius1.push_back(0.05f + 0.1f * std::abs(unit(random)));
    }
  return out;
}

Scene scene_with(const std::string& world) {
  return scene_of_text(
      "Camera \"perspective\" \"float shutteropen\" 0.5 \"float shutterclose\" 2\n"
      "TransformTimes 0 2\nWorldBegin\n" +
      world);
}

TEST(Intervals, HoldCapsulesAtEachTime) {
  Scene scene = scene_with("Shape \"disk\" \"float radius\" 9 \"float height\" -5\n");
  scene.shapes.emplace_back().geometry = far_capsules(40, {0, 0.7, 1.3, 1.301, 1.9, 4}, 4, 1);
  const auto& capsules = std::get<CapsulesShape>(scene.shapes.back().geometry);
  const FlatScene flat = lower(scene);
  const std::vector<std::uint32_t> roots = roots_of(flat);
  ASSERT_EQ(roots.size(), 16u);
  const CapsuleMotion motion(capsules, 0.5, 1.5);
  for (std::size_t k = 0; k < roots.size(); ++k) {
    std::vector<CapsulesShape> then;
    for (int i = 0; i <= 64; ++i) {
      const float time = (static_cast<float>(k) + static_cast<float>(i) / 64) / 16;
      then.push_back(motion.at(i == 64 && k < 15 ? std::nextafter(time, 0.0f) : time));
    }
    std::map<std::uint32_t, int> seen;
    std::vector<Box> way;
    visit(flat, roots[k], way,
          [&](std::uint32_t kind, std::uint32_t id, const std::vector<Box>& boxes) {
            ++seen[id];
            if (kind != shape_moving_capsule) return;
            for (const CapsulesShape& at : then) {
              const std::size_t i = id - 1;  // the disk is number 0
              const float r1 = (at.radius1.empty() ? at.radius0 : at.radius1)[i];
              for (const Box& box : boxes)
                EXPECT_TRUE(box.holds(at.p0[i], at.radius0[i]) && box.holds(at.p1[i], r1))
                    << "capsule " << i << " in interval " << k;
            }
          });
    EXPECT_EQ(seen.size(), 41u) << k;
    for (const auto& [id, times] : seen) EXPECT_EQ(times, 1) << id;
  }
}

/// Triangles that go `reach` to and fro, in so many intervals.
void expect_vertices_are_held(float reach, std::size_t intervals) {
  Scene scene = scene_with("");
  TriangleMeshShape mesh;
  mesh.times = {0.5, 1.1, 2};
  std::mt19937 random(2);
  std::uniform_real_distribution<float> unit(-1, 1);
  std::vector<vec3> still;
  for (int i = 0; i < 30; ++i) still.emplace_back(unit(random), unit(random), unit(random));
  for (const float shift : {0.0f, 2.0f, -1.0f})
    for (const vec3& p : still) mesh.positions.push_back(p + vec3(reach * shift, 0, 0));
  for (std::uint32_t i = 0; i < 30; i += 3) mesh.triangles.push_back({i, i + 1, i + 2});
  scene.shapes.emplace_back().geometry = mesh;
  const FlatScene flat = lower(scene);
  const std::vector<std::uint32_t> roots = roots_of(flat);
  ASSERT_EQ(roots.size(), intervals);
  const MeshMotion motion(mesh, 0.5, 1.5);
  for (std::size_t k = 0; k < roots.size(); ++k) {
    int seen = 0;
    std::vector<Box> way;
    visit(flat, roots[k], way, [&](std::uint32_t, std::uint32_t id, const std::vector<Box>& boxes) {
      ++seen;
      for (int i = 0; i < 64; ++i) {
        const float time =
            (static_cast<float>(k) + static_cast<float>(i) / 64) / static_cast<float>(roots.size());
        const TriangleMeshShape then = motion.at(time);
        for (const std::uint32_t corner : then.triangles[id])
          for (const Box& box : boxes)
            EXPECT_TRUE(box.holds(then.positions[corner], 0)) << id << " at " << time;
      }
    });
    EXPECT_EQ(seen, 10);
  }
}

TEST(Intervals, HoldVerticesAtEachTime) {
  expect_vertices_are_held(9, 16);
  expect_vertices_are_held(0.05f, 1);
}

// A ball of radius 1 goes from 0 to 100 while the shutter is open.
TEST(Intervals, HoldNoMoreThanIsSweptInThem) {
  for (const std::string& ball :
       {std::string("Shape \"capsules\" \"float times\" [0.5 2] \"point3 p0\" [0 0 0  100 0 0] "
                    "\"point3 p1\" [0 0 0  100 0 0] \"float radius\" [1 1]\n"),
        std::string("ObjectBegin \"ball\" Shape \"sphere\" ObjectEnd\n"
                    "ActiveTransform StartTime\nTranslate -33.33333333333333 0 0\n"
                    "ActiveTransform EndTime\nTranslate 100 0 0\nActiveTransform All\n"
                    "ObjectInstance \"ball\"\n"),
        std::string("ObjectBegin \"way\" Shape \"capsules\" \"float times\" [0.5 2] "
                    "\"point3 p0\" [0 0 0  0 100 0] \"point3 p1\" [0 0 0  0 100 0] "
                    "\"float radius\" [1 1] ObjectEnd\nRotate -90 0 0 1\n"
                    "ObjectInstance \"way\"\n")}) {
    const FlatScene flat = lower(scene_with(ball));
    const std::vector<std::uint32_t> roots = roots_of(flat);
    ASSERT_EQ(roots.size(), 16u) << ball;
    for (std::size_t k = 0; k < 16; ++k) {
      const Box box = bounds_of_tree(flat, roots[k]);
      EXPECT_NEAR(box.min[0], 6.25 * static_cast<double>(k) - 1, 0.002) << k << ball;
      EXPECT_NEAR(box.max[0], 6.25 * static_cast<double>(k + 1) + 1, 0.002) << k << ball;
      EXPECT_NEAR(box.max[1], 1, 0.002);
    }
    // Bounds of the world hold all of them.
    EXPECT_NEAR(flat.world.center_x, 50, 0.01);
    EXPECT_GE(flat.world.radius, 51);
    // A tree of one ball costs the same wherever it is.
    EXPECT_NEAR(flat.bvh_sah, lower(scene_with("Shape \"sphere\"\n")).bvh_sah, 1e-6);
  }
}

TEST(Intervals, AreOneWhereLittleMoves) {
  for (const auto& [distance, intervals] :
       {std::pair(0.5, 1u), std::pair(1.0, 1u), std::pair(6.0, 4u), std::pair(1000.0, 16u)}) {
    const FlatScene flat =
        lower(scene_with("Shape \"capsules\" \"float times\" [0.5 2] \"point3 p0\" [0 0 0  " +
                         std::to_string(distance) + " 0 0] \"point3 p1\" [0 0 0  " +
                         std::to_string(distance) + " 0 0] \"float radius\" [1 1]\n"));
    // Half the area of the box is 4 + 4 (2 + distance / n), which each halving has to make smaller
    // by a fifth.
    double least = 1e300;
    std::uint32_t best = 0;
    for (std::uint32_t n = 1, halvings = 0; n <= 16; n *= 2, ++halvings) {
      const double cost = (4 + 4 * (2 + distance / n)) * std::pow(1.25, halvings);
      if (cost < least) least = cost, best = n;
    }
    EXPECT_EQ(best, intervals);
    EXPECT_EQ(roots_of(flat).size(), intervals) << distance;
  }
}

// What rests stands in the tree once.
TEST(Intervals, ShareWhatRests) {
  const std::string fast =
      "Shape \"capsules\" \"float times\" [0.5 2] \"point3 p0\" [0 0 0  0 900 0] \"point3 p1\" "
      "[0 0 0  0 900 0] \"float radius\" [1 1]\n";
  std::string text;
  for (int i = 0; i < 2000; ++i)
    text += "Shape \"sphere\" \"float radius\" 0.4\nTranslate 1 0.2 0.1\n";
  const FlatScene still = lower(scene_with(text));
  const FlatScene moving = lower(scene_with(fast + text));
  ASSERT_EQ(roots_of(moving).size(), 16u);
  EXPECT_EQ(moving.nodes.size(), still.nodes.size() + std::size_t{32} * CAPLET_NODE_FLOATS);
  EXPECT_EQ(moving.bvh_nodes, still.bvh_nodes + 32);
  EXPECT_EQ(moving.bvh_depth, still.bvh_depth + 1);
  EXPECT_GT(moving.bvh_sah, 1);
  std::vector<Box> way;
  for (const std::uint32_t root : roots_of(moving)) {
    int seen = 0;
    visit(moving, root, way, [&](auto, auto, const auto&) { ++seen; });
    EXPECT_EQ(seen, 2001);
  }
}

/// Capsules that go far in the world and in an object, which is placed where it rests and where it
/// moves, beside capsules that share their points, loose ones and an ellipsoid that rest.
Scene far_scene() {
  Scene scene = scene_with(R"(
Shape "disk" "float radius" 20 "float height" -5
ObjectBegin "swarm" Shape "sphere" "float radius" 0.2 ObjectEnd
AttributeBegin Scale 0.5 1 2 Shape "sphere" AttributeEnd
ObjectInstance "swarm"
AttributeBegin
  Translate 2 0 0
  ActiveTransform EndTime
  Rotate 70 0 1 1
  Translate 3 0 1
  ActiveTransform All
  ObjectInstance "swarm"
AttributeEnd
)");
  scene.shapes.emplace_back().geometry = far_capsules(60, {0, 1.3, 1.9, 4}, 3, 3);
  scene.objects[0].shapes.emplace_back().geometry = far_capsules(20, {0.5, 2}, 2, 4);
  CapsulesShape row;
  for (int i = 0; i < 20; ++i) {
    const auto at = [](int k) {
      const float a = 0.1f * static_cast<float>(k);
      return vec3(3 * std::cos(a), 3 * std::sin(a), 0.02f * static_cast<float>(k) - 2);
    };
    row.p0.push_back(at(i));
    row.p1.push_back(at(i + 1));
    row.radius0.push_back(0.5f);
  }
  scene.shapes.emplace_back().geometry = row;
  return scene;
}

TEST(Intervals, HaveTheHitsOfTheSceneAtEachTime) {
  const Scene scene = far_scene();
  const FlatScene flat = lower(scene);
  ASSERT_EQ(flat.world.intervals, 16u);
  EXPECT_EQ(std::ranges::count_if(flat.instances, [](auto& one) { return one.intervals > 1; }), 2);
  expect_hits_of_frozen(scene, shape_moving_capsule, {shape_sphere, shape_tapered_capsule});
}

}  // namespace
}  // namespace caplet::test::intervals_test
