// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Hits of rays that see a scene at their times: those of the scene frozen then, by the kernels to
// the bit and by the reference within its bounds.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <random>

#include "frozen_hits.h"
#include "lower/lower.h"
#include "lower/motion.h"
#include "render/query.h"
#include "render_scene.h"
#include "scene/frozen.h"
#include "support/rays.h"
#include "support/test_scale.h"

namespace caplet::test {
namespace {

using glm::dvec3;

/// All kinds of shapes that turn, grow and shift, some mirrored, among some that rest.
Scene moving_scene() {
  return scene_of_text(R"(
Camera "perspective" "float shutteropen" 0.25 "float shutterclose" 1.5
TransformTimes 0 2
WorldBegin
Shape "disk" "float radius" 20 "float height" -3
ObjectBegin "many"
  Shape "capsule" "point3 p0" [-1 0 0] "point3 p1" [1 0 0.5] "float radius" 0.3
  Shape "cone" "point3 p0" [0 0 0] "point3 p1" [0 1.5 0] "float radius" [0.5 0.2]
  Shape "box" "point3 p0" [-0.5 -1 -0.5] "point3 p1" [0.2 -0.4 0.6]
  Shape "sphere" "float radius" 0.5
  AttributeBegin
    Scale 1 0.5 0.7
    Shape "sphere" "float radius" 1
  AttributeEnd
ObjectEnd
AttributeBegin
  Translate -3 0 0
  ActiveTransform EndTime
  Rotate 150 1 1 0
  Translate 1 0.5 0
  Scale 1.5 0.7 1
  ActiveTransform All
  ObjectInstance "many"
AttributeEnd
AttributeBegin
  Scale -1 1 1
  Translate -3 0 0
  ActiveTransform StartTime
  Rotate 80 0 1 0
  ActiveTransform All
  ObjectInstance "many"
AttributeEnd
AttributeBegin
  ActiveTransform EndTime
  Translate 0 3 1
  Rotate 100 0 0 1
  ActiveTransform All
  Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point3 P" [-1 -1 0 1 -1 0 1 1 0 -1 1 0.5]
  Shape "cylinder" "float radius" 0.4 "float zmin" -1 "float zmax" 1.5
  Shape "bilinearmesh" "point3 P" [-1 -1 1 1 -1 1.5 -1 1 1 1 1 1]
AttributeEnd
AttributeBegin
  Translate 0 -3 0
  ObjectInstance "many"
AttributeEnd
)");
}

std::vector<RayRecord> rays_through(std::size_t count, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto in_cube = [&] { return dvec3(unit(random), unit(random), unit(random)); };
  std::vector<RayRecord> out;
  for (std::size_t i = 0; i < count; ++i) {
    const dvec3 o = 8.0 * in_cube();
    out.push_back(make_ray(o, (3.0 * in_cube() - o) * std::exp2(3 * unit(random))));
  }
  return out;
}

std::vector<float> random_times(std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> unit(0, 1);
  std::vector<float> out(count);
  for (float& time : out) time = unit(random);
  return out;
}

bool same(const PickRecord& a, const PickRecord& b) { return std::memcmp(&a, &b, sizeof a) == 0; }

/// The records of a scene that stands still at a time of its shutter, as the kernels would have
/// them: matrices of floats that are the motion's. Its trees, too, are those of the moving scene.
FlatScene stopped(FlatScene flat, float time) {
  for (InstanceRecord& one : flat.instances) {
    if (one.motion_segments == 0) continue;
    const std::span<const float> motion = std::span(flat.leaves).subspan(one.motion_begin);
    const auto object_from_world = motion_at(motion, one.motion_segments, 2, 0, time),
               world_from_object = motion_at(motion, one.motion_segments, 2, 1, time);
    std::ranges::copy(object_from_world, one.object_from_world);
    std::ranges::copy(world_from_object, one.world_from_object);
    one.motion_segments = 0;
  }
  return flat;
}

TEST(MovingHits, AreThoseOfTheSceneThatIsStopped) {
  const Scene scene = moving_scene();
  const FlatScene flat = lower(scene);
  ASSERT_TRUE(flat.moves());
  ASSERT_EQ(
      std::ranges::count_if(flat.instances, [](auto& one) { return one.motion_segments > 0; }),
      7);  // two of `many`, each with its ellipsoid; a mesh, a cylinder, a patch
  const auto count = static_cast<std::size_t>(2000 * test_scale());
  const std::vector<RayRecord> rays = rays_through(count, 1);
  for (const Encoding encoding : {Encoding::wide, Encoding::single}) {
    Query moving(flat, test_device(encoding));
    for (const float time : {0.0f, 0.123f, 0.5f, 0.999f}) {
      Query still(stopped(flat, time), test_device(encoding));
      const std::vector<float> times(count, time);
      const auto found = moving.closest(rays, times), expected = still.closest(rays);
      const HitLists lists = moving.all(rays, 64, times), all = still.all(rays, 64);
      ASSERT_EQ(lists.begin, all.begin);
      std::size_t hits = 0, errors = 0;
      for (std::size_t i = 0; i < count; ++i) {
        // A point of a moving thing has a wider bound (docs/numerics.md).
        PickRecord own = found[i];
        EXPECT_GE(own.error, expected[i].error);
        errors += own.error > expected[i].error ? 1 : 0;
        own.error = expected[i].error;
        EXPECT_TRUE(same(own, expected[i])) << i;
        hits += std::isfinite(own.t) && own.object != 0 ? 1 : 0;
      }
      for (std::size_t i = 0; i < lists.crossings.size(); ++i)
        EXPECT_EQ(lists.crossings[i].t, all.crossings[i].t);
      EXPECT_GT(hits, count / 6);
      EXPECT_GT(errors, count / 8);
    }
  }
}

TEST(MovingHits, DependOnTheirRaysTimesAlone) {
  const Scene scene = moving_scene();
  const FlatScene flat = lower(scene);
  const std::vector<RayRecord> rays = rays_through(3000, 2);
  const std::vector<float> times = random_times(rays.size(), 3);
  Query whole(flat, test_device()), pieces(flat, test_device(), {.batch_rays = 64});
  const auto together = whole.closest(rays, times), apart = pieces.closest(rays, times);
  const auto at_opening = whole.closest(rays);
  std::size_t others = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    EXPECT_TRUE(same(together[i], apart[i])) << i;
    others += same(together[i], at_opening[i]) ? 0 : 1;
  }
  EXPECT_GT(others, rays.size() / 6);
}

// The reference inverts, in double, the matrices that AnimatedTransform gives.
TEST(MovingHits, AreTheReferencesOfTheFrozenScene) {
  const BesideReference found = beside_reference(
      moving_scene(), random_times(16, 4), [](unsigned seed) { return rays_through(250, seed); });
  EXPECT_GT(found.hits, 4000);
  EXPECT_GT(found.near, found.hits - 40);
  EXPECT_LT(found.apart, 40);
}

}  // namespace
}  // namespace caplet::test
