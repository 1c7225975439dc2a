// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Csg shapes whose operands move: by closed forms, as the shape that stands still at each time, and
// within the reference's bounds.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
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
#include "shared/shapes.h"
#include "support/rays.h"
#include "support/test_scale.h"

namespace caplet::test {
namespace {

using glm::dvec3;
using testing::ElementsAre;
using testing::FloatEq;
using testing::FloatNear;

/// A box from which a ball that moves from x = -1 to x = 1 is taken away.
const std::string drilled =
    "Camera \"perspective\" \"float shutteropen\" 0 \"float shutterclose\" 1\nWorldBegin\n"
    "ObjectBegin \"block\"\nShape \"box\" \"point3 p0\" [-1 -1 -1] \"point3 p1\" [1 1 1]\n"
    "ObjectEnd\nObjectBegin \"ball\"\nTranslate -1 0 0\nActiveTransform EndTime\nTranslate 2 0 0\n"
    "ActiveTransform All\nShape \"sphere\" \"float radius\" 0.5\nObjectEnd\n"
    "Shape \"csg\" \"string operation\" \"difference\" \"string operands\" [\"block\" \"ball\"]\n";

std::vector<float> crossings(const FlatScene& flat, const RayRecord& ray, float time) {
  std::vector<float> out;
  for (const Encoding encoding : {Encoding::wide, Encoding::single}) {
    const HitLists lists = Query(flat, test_device(encoding)).all({{ray}}, 64, {{time}});
    std::vector<float> own;
    for (const auto& crossing : lists.crossings) own.push_back(crossing.t);
    if (encoding == Encoding::single) {
      EXPECT_EQ(own, out);
    }
    out = own;
  }
  return out;
}

TEST(MovingOperands, CutWhereTheyAre) {
  const FlatScene flat = lower(scene_of_text(drilled));
  EXPECT_TRUE(flat.moves());
  const RayRecord ray = make_ray({-5, 0, 0}, {1, 0, 0});
  const auto near = [](float t) { return FloatNear(t, 4e-6f); };
  EXPECT_THAT(crossings(flat, ray, 0), ElementsAre(near(4.5f), near(6)));
  EXPECT_THAT(crossings(flat, ray, 0.375f),
              ElementsAre(near(4), near(4.25f), near(5.25f), near(6)));
  EXPECT_THAT(crossings(flat, ray, 0.5f), ElementsAre(near(4), near(4.5f), near(5.5f), near(6)));
  EXPECT_THAT(crossings(flat, ray, 1), ElementsAre(near(4), near(5.5f)));
  // The normal of the ball's dent is along the ray.
  Query query(flat, test_device());
  const auto pick = query.closest({{ray}}, std::vector<float>{0})[0];
  EXPECT_NEAR(pick.normal[0], -1, 1e-6);
  EXPECT_NEAR(pick.point[0], -0.5, 1e-6);
}

TEST(MovingOperands, RestBeforeAndAfterTheirTimes) {
  std::string text = drilled;
  text.replace(text.find("shutteropen\" 0"), 14, "shutteropen\" 2")
      .replace(text.find("shutterclose\" 1"), 15, "shutterclose\" 3");
  const FlatScene late = lower(scene_of_text(text));
  EXPECT_FALSE(late.moves());
  EXPECT_THAT(crossings(late, make_ray({-5, 0, 0}, {1, 0, 0}), 0),
              ElementsAre(FloatNear(4, 4e-6f), FloatNear(5.5f, 4e-6f)));
}

/// A block that turns, drilled by a cone that turns and shifts; a capsule whose ends move joined to
/// half of an ellipsoid that grows; a lens of two balls one of which comes closer, placed by an
/// instance that turns; a csg that moves within another.
Scene machines() {
  return scene_of_text(R"(
Camera "perspective" "float shutteropen" 0.25 "float shutterclose" 1.5
TransformTimes 0 2
WorldBegin
ObjectBegin "block"
  ActiveTransform EndTime
  Rotate 100 1 1 0
  ActiveTransform All
  Shape "box" "point3 p0" [-1 -0.8 -0.6] "point3 p1" [1 0.8 0.6]
ObjectEnd
ObjectBegin "drill"
  Translate 0.3 0 0
  ActiveTransform EndTime
  Translate -0.5 0.3 0
  Rotate 70 0 0 1
  Scale 1.2 0.9 1
  ActiveTransform All
  Shape "cone" "point3 p0" [0 -2 0] "point3 p1" [0 2 0] "float radius" [0.4 0.2]
ObjectEnd
ObjectBegin "worm"
  Shape "capsules" "float times" [0 1 2] "point3 p0" [-1 0 0 -1 0 1 0 0 1] "point3 p1" [1 0 0 1 1 0 1 0 0]
    "float radius" [0.3 0.2 0.4] "float radius1" [0.3 0.4 0.4]
ObjectEnd
ObjectBegin "egg"
  Scale 1 0.5 0.7
  ActiveTransform EndTime
  Scale 1.5 1.2 0.8
  ActiveTransform All
  Shape "sphere"
ObjectEnd
ObjectBegin "left"
  Shape "sphere" "float radius" 1
ObjectEnd
ObjectBegin "right"
  Translate 1.2 0 0
  ActiveTransform EndTime
  Translate -0.8 0.5 0
  ActiveTransform All
  Shape "sphere" "float radius" 1
ObjectEnd
ObjectBegin "drilled"
  ActiveTransform EndTime
  Translate 0 0 0.7
  Rotate 40 0 1 0
  ActiveTransform All
  Shape "csg" "string operation" "difference" "string operands" ["block" "drill"]
ObjectEnd
AttributeBegin
  Translate -3 0 0
  Scale 1.2 1 0.9
  Shape "csg" "string operation" "difference" "string operands" ["block" "drill"]
AttributeEnd
AttributeBegin
  Translate 0 3 0
  Shape "csg" "string operation" "union" "string operands" ["worm" "egg"]
AttributeEnd
ObjectBegin "lens"
  Shape "csg" "string operation" "intersection" "string operands" ["left" "right"]
ObjectEnd
AttributeBegin
  Translate 3 0 0
  ActiveTransform EndTime
  Rotate 120 0 1 1
  ActiveTransform All
  ObjectInstance "lens"
AttributeEnd
Translate 0 -3 0
Shape "csg" "string operation" "difference" "string operands" ["drilled" "left"]
)");
}

std::vector<RayRecord> rays_at_machines(std::size_t count, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto in_cube = [&] { return dvec3(unit(random), unit(random), unit(random)); };
  constexpr std::array<dvec3, 4> middles{dvec3(-3, 0, 0), dvec3(0, 3, 0), dvec3(3, 0, 0),
                                         dvec3(0, -3, 0)};
  std::vector<RayRecord> out;
  for (std::size_t i = 0; i < count; ++i) {
    const dvec3 o = 8.0 * in_cube();
    out.push_back(make_ray(o, middles[i % 4] + in_cube() - o));
  }
  return out;
}

/// The same records with the operands' matrices as the kernels have them at a time.
FlatScene stopped(FlatScene flat, float time, std::size_t& stops) {
  const auto number = [&](std::size_t at) -> float& { return flat.leaves[at]; };
  const auto whole = [&](std::size_t at) { return std::bit_cast<std::uint32_t>(number(at)); };
  std::vector<std::size_t> begins;  // of csg headers, which leaf blocks name
  for (std::size_t i = 0; i + 64 < flat.leaves.size(); i += 8) begins.push_back(i);
  for (const std::size_t begin : begins) {
    // Rows of groups: a kind of solid, a block and a motion within the leaves.
    const std::uint32_t kind = whole(begin), motion = whole(begin + 4), segments = whole(begin + 6);
    if (kind >= shape_count || segments == 0 || segments > 64 || motion >= flat.leaves.size() ||
        whole(begin + 1) >= flat.leaves.size() || whole(begin + 2) != 1 || whole(begin + 7) != 0)
      continue;
    const std::vector<float> copy(flat.leaves.begin() + motion, flat.leaves.end());
    number(begin + 4) = std::bit_cast<float>(static_cast<std::uint32_t>(flat.leaves.size()));
    number(begin + 6) = 0;
    for (const std::uint32_t matrix : {0U, 1U})
      for (const float entry : motion_at(copy, segments, 2, matrix, time))
        flat.leaves.push_back(entry);
    ++stops;
  }
  return flat;
}

bool are_alike(const PickRecord& a, const PickRecord& b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

TEST(MovingOperands, AreThoseOfTheShapeThatIsStopped) {
  const FlatScene flat = lower(machines());
  const auto count = static_cast<std::size_t>(2000 * test_scale());
  const std::vector<RayRecord> rays = rays_at_machines(count, 1);
  for (const Encoding encoding : {Encoding::wide, Encoding::single}) {
    Query moving(flat, test_device(encoding));
    for (const float time : {0.0f, 0.123f, 0.5f, 0.999f}) {
      std::size_t stops = 0, hits = 0;
      Query still(stopped(flat, time, stops), test_device(encoding));
      // The block and the drill, twice; the egg; the right ball.
      ASSERT_EQ(stops, 6u);
      const std::vector<float> times(count, time);
      const auto found = moving.closest(rays, times), expected = still.closest(rays, times);
      for (std::size_t i = 0; i < count; ++i) {
        EXPECT_TRUE(are_alike(found[i], expected[i])) << i;
        hits += std::isfinite(found[i].t) ? 1 : 0;
      }
      EXPECT_GT(hits, count / 4);
      EXPECT_EQ(moving.all(rays, 64, times).begin, still.all(rays, 64, times).begin);
    }
  }
}

TEST(MovingOperands, AreTheReferencesOfTheFrozenScene) {
  std::vector<float> times;
  for (int k = 0; k < 16; ++k) times.push_back(static_cast<float>(k) / 15);
  const BesideReference found = beside_reference(
      machines(), times, [](unsigned seed) { return rays_at_machines(300, seed); });
  EXPECT_GT(found.hits, 3000);
  EXPECT_GT(found.near, found.hits - 30);
  EXPECT_LT(found.apart, 30);
}

TEST(MovingOperands, LieWithinTheBoundsOfTheScene) {
  const Scene scene = machines();
  const Bounds whole = bounds_of(scene);
  for (int k = 0; k <= 32; ++k) {
    const Bounds now = bounds_of(frozen_at(scene, 2.0 * k / 32));
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_GE(now.min[axis], whole.min[axis]) << k;
      EXPECT_LE(now.max[axis], whole.max[axis]) << k;
    }
  }
}

}  // namespace
}  // namespace caplet::test
