// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Capsules whose ends and radii move: hits are to the bit those of the capsules that stand still as
// they are at the ray's time.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "frozen_hits.h"
#include "lower/lower.h"
#include "render_scene.h"
#include "scene/frozen.h"
#include "scene/shapes/capsule_motion.h"
#include "shared/shapes.h"

namespace caplet::test::capsules_test {
namespace {

using glm::vec3;

/// Capsules of all kinds: each has equal or different radii, and ends that meet, at each time.
CapsulesShape random_capsules(std::size_t count, std::vector<double> times, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> unit(-1, 1);
  const auto radius = [&] { return 0.1f + 0.3f * std::abs(unit(random)); };
  CapsulesShape out;
  out.times = std::move(times);
  for (std::size_t key = 0; key < out.times.size(); ++key)
    for (std::size_t i = 0; i < count; ++i) {
      const vec3 p(3 * unit(random), 3 * unit(random), 3 * unit(random));
      const bool is_sphere = i % 5 < 2, is_even = i % 5 == 0 || i % 5 == 2;
      out.p0.push_back(p);
      out.p1.push_back(is_sphere ? p : p + vec3(unit(random), unit(random), unit(random)));
      out.radius0.push_back(radius());
      out.radius1.push_back(is_even ? out.radius0.back() : radius());
    }
  for (std::size_t i = 0; i < count; ++i) out.u.emplace_back(unit(random), unit(random));
  return out;
}

/// Capsules of the world, others of an object that turns, and some that move only before the
/// shutter opens, from 0.5 to 2 seconds.
Scene moving_scene() {
  Scene scene = scene_of_text(
      "Camera \"perspective\" \"float shutteropen\" 0.5 \"float shutterclose\" 2\nTransformTimes 0 "
      "2\nWorldBegin\nShape \"disk\" \"float radius\" 20 \"float height\" -5\nObjectBegin "
      "\"turned\" Shape \"sphere\" ObjectEnd\nTranslate 1 0 0\nActiveTransform EndTime\nRotate 70 "
      "0 "
      "1 1\nActiveTransform All\nObjectInstance \"turned\"\n");
  const auto add = [&](std::vector<Shape>& to, CapsulesShape capsules) {
    Shape& shape = to.emplace_back();
    shape.geometry = std::move(capsules);
  };
  add(scene.shapes, random_capsules(30, {0, 0.8, 1.3, 1.9, 4}, 1));
  add(scene.shapes, random_capsules(10, {0, 2.5}, 2));
  add(scene.shapes, random_capsules(10, {0, 0.5}, 3));
  add(scene.objects[0].shapes, random_capsules(10, {0.5, 2}, 4));
  return scene;
}

TEST(MovingCapsules, AreToTheBitWhatTheyAreAtEachTime) {
  expect_hits_of_frozen(moving_scene(), shape_moving_capsule,
                        {shape_sphere, shape_capsule, shape_tapered_capsule});
}

// Ends move evenly from 1 to 2 seconds, and rest before and after; the shutter is open longer.
TEST(MovingCapsules, GoStraightAndEvenly) {
  CapsulesShape capsules{{{0, 0, 0}, {4, 0, 2}}, {{0, 1, 0}, {0, 1, 8}}, {1, 3}, {2, 2}, {}};
  capsules.times = {1, 2};
  EXPECT_EQ(count_of(capsules), 1u);
  const CapsuleMotion motion(capsules, 0, 4);
  EXPECT_EQ(motion.times().segments(), 3u);
  EXPECT_FALSE(motion.rests());
  for (const auto& [time, share] :
       {std::pair(0.0f, 0.0f), std::pair(0.25f, 0.0f), std::pair(0.3125f, 0.25f),
        std::pair(0.4375f, 0.75f), std::pair(0.5f, 1.0f), std::pair(1.0f, 1.0f)}) {
    for (const CapsulesShape& at : {motion.at(time), at_time(capsules, 4 * double{time})}) {
      EXPECT_EQ(at.p0, std::vector<vec3>{vec3(4 * share, 0, 2 * share)});
      EXPECT_EQ(at.p1, std::vector<vec3>{vec3(0, 1, 8 * share)});
      EXPECT_EQ(at.radius0, std::vector<float>{1 + 2 * share});
      EXPECT_EQ(at.radius1.empty() ? at.radius0 : at.radius1, std::vector<float>{2});
      EXPECT_TRUE(at.times.empty());
    }
  }
  EXPECT_TRUE(CapsuleMotion(capsules, 2, 5).rests());
  EXPECT_TRUE(CapsuleMotion(capsules, -3, 4).rests());
}

// Where a short last segment begins is rounded, and so is one over its length: at its end their
// product may be more than 1.
TEST(MovingCapsules, HaveNoNegativeRadius) {
  CapsulesShape capsules{{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}},
                         {{0, 1, 0}, {0, 1, 0}, {0, 1, 0}},
                         {1, 1, 0},
                         {1, 1, 1},
                         {}};
  bool is_beyond = false;
  for (int n = 2; n < 2000; ++n) {
    capsules.times = {0, 1 - 1.0 / n, 1};
    const CapsuleMotion motion(capsules, 0, 1);
    is_beyond |= (1 - motion.times().pairs()[2]) * motion.times().pairs()[3] > 1;
    ASSERT_GE(motion.at(1).radius0[0], 0) << n;
  }
  EXPECT_TRUE(is_beyond);
}

// What rests while the shutter is open is as light and fast as what never moves.
TEST(MovingCapsules, ThatRestAreOfTheirKinds) {
  Scene scene = moving_scene();
  scene.shapes.erase(scene.shapes.begin() + 1, scene.shapes.begin() + 3);
  scene.objects[0].shapes.pop_back();
  const FlatScene flat = lower(scene);
  EXPECT_EQ(flat.shapes & shape_bit(shape_moving_capsule), 0u);
  EXPECT_NE(flat.shapes & shape_bit(shape_tapered_capsule), 0u);
}

TEST(MovingCapsules, AreWithinTheirBounds) {
  const CapsulesShape capsules = random_capsules(20, {0, 1, 3}, 5);
  const Bounds bounds = bounds_under(capsules, glm::dmat4(1));
  Bounds swept;
  for (int k = 0; k <= 300; ++k)
    swept.extend(bounds_under(at_time(capsules, 0.01 * k), glm::dmat4(1)));
  EXPECT_EQ(swept.min, bounds.min);  // the ends of what moves straight are at its times
  EXPECT_EQ(swept.max, bounds.max);
}

}  // namespace
}  // namespace caplet::test::capsules_test
