// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Whole scenes of all shapes, lowered, against the scene reference: what is hit, in which order,
// named by which object, primitive, surface and material. CAPLET_TEST_SCALE=N tries N times as many
// scenes.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <mutex>
#include <random>

#include "list_tracer.h"
#include "random_scene.h"
#include "scene_probe.h"
#include "shared/kinds.h"
#include "support/test_device.h"
#include "support/test_scale.h"
#include "verify/verify.h"

namespace caplet::test::scenes_test {
namespace {

using glm::dmat4;
using glm::dvec3;

constexpr std::uint32_t capacity = 200;

std::vector<RayRecord> random_rays(std::uint32_t seed, int count) {
  SceneMaker make(seed);
  std::vector<RayRecord> out;
  for (int i = 0; i < count; ++i) {
    const dvec3 o = make.uniform(0, 12) * make.direction();
    const dvec3 d =
        make.below(8) == 0 ? dvec3(0, 0, 1) : 5 * make.uniform(0, 1) * make.direction() - o;
    out.push_back(make_ray(o, d * std::pow(10.0, make.uniform(-1, 1))));
  }
  return out;
}

struct Tally {
  std::size_t rays = 0, crossings = 0, grazing = 0, failures = 0;
  std::array<std::size_t, reference::kind_names.size()> kinds{};
};

/// What is hit, where, in which order; of which object, primitive, surface and material; points,
/// normals and uv.
void compare(const Scene& scene, const std::vector<RayRecord>& rays, Tally& tally) {
  static const std::vector<Device> devices{test_device()};
  std::mutex mutex;
  verify::SceneCheck check(scene, devices);
  check.check(rays, [&](const verify::SceneCheck::Checked& ray) {
    const verify::Outcome& outcome = ray.outcomes[0];
    const std::lock_guard lock(mutex);
    ++tally.rays;
    tally.crossings += outcome.matches.size();
    tally.grazing += !outcome.grazed.empty();
    for (const verify::Match& match : outcome.matches)
      ++tally.kinds[reference::kind_of(check.reference().placed(match.primitive).primitive)];
    for (const verify::Disagreement& wrong : outcome.disagreements)
      if (++tally.failures <= 5) {
        const RayRecord& r = rays[ray.ray];
        ADD_FAILURE() << wrong.text
                      << fmt::format("\nray {:a} {:a} {:a}  {:a} {:a} {:a}", r.ox, r.oy, r.oz, r.dx,
                                     r.dy, r.dz);
      }
  });
}

void report(const Tally& tally) {
  std::printf("%zu rays, %zu crossings, %zu grazing, %zu failures\n", tally.rays, tally.crossings,
              tally.grazing, tally.failures);
  EXPECT_EQ(tally.failures, 0u);
  EXPECT_GT(tally.crossings, tally.rays);
  EXPECT_LT(tally.grazing, tally.rays / 50);
}

TEST(Scenes, OfAllShapesAgreeWithTheReference) {
  Tally tally;
  for (int i = 0; i < 6 * test_scale(); ++i)
    compare(random_scene(100 + static_cast<std::uint32_t>(i)),
            random_rays(200 + static_cast<std::uint32_t>(i), 2000), tally);
  report(tally);
  for (std::size_t k = 0; k < tally.kinds.size(); ++k)
    EXPECT_GT(tally.kinds[k], 200u) << reference::kind_names[k];
}

// Faces that the mesh's normals turn over keep their uvs; capsules of one point have the z axis of
// their own space.
TEST(Scenes, OfTurnedFacesAndBalls) {
  SceneMaker make(5);
  Scene scene;
  scene.materials.push_back({DiffuseMaterial{}, "", {}});
  for (int i = 0; i < 24; ++i) {
    const glm::vec3 a(make.direction()), b(make.direction()), c(make.direction()),
        d(make.direction());
    const std::vector<glm::vec3> normals(4, glm::vec3(make.direction()));
    Shape shape;
    shape.world_from_object = make.placement(4);
    if (i % 3 == 0)
      shape.geometry = TriangleMeshShape{{a, b, c, d}, {{0, 1, 2}, {1, 2, 3}}, normals, {}};
    if (i % 3 == 1) shape.geometry = BilinearMeshShape{{a, b, c, d}, {{0, 1, 2, 3}}, normals, {}};
    if (i % 3 == 2)
      shape.geometry = CapsulesShape{{a, b}, {a, b + 0.1f * c}, {0.6f, 0.5f}, {0.3f, 0.9f}, {}};
    if (i % 6 == 5) std::get<CapsulesShape>(shape.geometry).u = {{0.25f, 0.5f}, {0.5f, 2}};
    scene.shapes.push_back(shape);
  }
  Tally tally;
  compare(scene, random_rays(6, 10000), tally);
  report(tally);
}

// Eight primitives at a time or one: the same crossings of the same primitives. Contraction may
// differ between the two, so that rays that graze may differ in both.
TEST(Scenes, AreTheSameForBothWidths) {
  int rays_compared = 0, different = 0, crossings = 0;
  for (std::uint32_t i = 0; i < 4; ++i) {
    const Scene scene = random_scene(300 + i);
    const FlatScene flat = lower(scene);
    const std::vector<RayRecord> rays = random_rays(400 + i, 2000);
    const std::vector<RayList> wide = list_tracer(8).trace(flat, rays, capacity),
                               scalar = list_tracer(1).trace(flat, rays, capacity);
    for (std::size_t k = 0; k < rays.size(); ++k) {
      ++rays_compared;
      bool same = wide[k].hits.size() == scalar[k].hits.size() && wide[k].any == scalar[k].any;
      for (std::size_t n = 0; same && n < wide[k].hits.size(); ++n) {
        const HitRecord &a = wide[k].hits[n], &b = scalar[k].hits[n];
        ++crossings;
        same = a.slot == b.slot && a.instance == b.instance && a.surface == b.surface &&
               std::abs(a.t - b.t) <= 1e-5f * std::abs(a.t);
      }
      different += !same;
    }
  }
  std::printf("%d rays, %d crossings, %d rays differ\n", rays_compared, crossings, different);
  EXPECT_GT(crossings, rays_compared);
  // 1e-5 of t along a grazing ray; crossings of two shapes closer together than rounding.
  EXPECT_LE(different, rays_compared / 400);
}

TEST(Scenes, LimitsOfTheRay) {
  const Scene scene = random_scene(500);
  const FlatScene flat = lower(scene);
  const std::vector<RayRecord> rays = random_rays(501, 3000);
  const std::vector<RayList> all = list_tracer().trace(flat, rays, capacity);
  std::vector<RayRecord> below = rays, at = rays, beyond = rays;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (all[i].hits.empty()) continue;
    const float t = all[i].hits[all[i].hits.size() / 2].t;
    below[i].t_max = t;                          // the crossing itself is not in the open interval
    at[i].t_max = std::nextafter(t, HUGE_VALF);  // just inside
    beyond[i].t_min = t;                         // those behind it
  }
  const auto lists_below = list_tracer().trace(flat, below, capacity),
             lists_at = list_tracer().trace(flat, at, capacity),
             lists_beyond = list_tracer().trace(flat, beyond, capacity);
  int counted = 0, odd = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (all[i].hits.empty()) continue;
    ++counted;
    const float t = all[i].hits[all[i].hits.size() / 2].t;
    const auto among = [&](const auto& keep) {
      return std::count_if(all[i].hits.begin(), all[i].hits.end(), keep);
    };
    EXPECT_EQ(lists_below[i].hits.size(), among([&](const HitRecord& hit) { return hit.t < t; }))
        << i;
    EXPECT_EQ(lists_at[i].hits.size(), among([&](const HitRecord& hit) { return hit.t <= t; }))
        << i;
    // Csg shapes take crossings closer together than their bounds as one, and that as behind when
    // it begins there.
    odd += lists_beyond[i].hits.size() !=
           static_cast<std::size_t>(among([&](const HitRecord& hit) { return hit.t > t; }));
    for (const RayList* list : {&lists_below[i], &lists_at[i], &lists_beyond[i]}) {
      EXPECT_EQ(list->any, !list->hits.empty()) << i;
      if (!list->hits.empty()) {
        EXPECT_EQ(list->closest.t, list->hits[0].t) << i;
      }
    }
  }
  EXPECT_GT(counted, 1000);
  EXPECT_LE(odd, counted / 100);
}

// Rays go to object space unnormalised: t is one measure for all. Were directions normalised there,
// a shape stretched along the ray by s would have its t divided by s, and all but the first would
// be out of order.
TEST(Scenes, StretchedNeighboursAreInOrder) {
  SceneMaker make(7);
  Scene scene;
  scene.materials.push_back({DiffuseMaterial{}, "", {}});
  std::vector<double> expected;
  int misplaced = 0;
  double z = 0, last = 0;
  for (int i = 0; i < 24; ++i) {
    const double half = std::pow(10.0, make.uniform(-1.5, 1.5)), gap = make.uniform(0.01, 0.2);
    Shape ball;
    ball.geometry = SphereShape{1};
    const dmat4 placed =
        glm::scale(glm::translate(dmat4(1), dvec3(0, 0, z + gap + half)), dvec3(1, 1, half));
    expected.push_back(z + gap);
    expected.push_back(z + gap + 2 * half);
    z = expected.back();
    // From z = -1: what a normalised ray would say.
    const double normalised = (expected[expected.size() - 2] + 1) / half;
    misplaced += normalised < last;
    last = normalised;
    if (i % 2 == 0) {
      ball.world_from_object = placed;
      scene.shapes.push_back(ball);
    } else {
      scene.objects.push_back({fmt::format("{}", i), {ball}, {}});
      scene.instances.push_back({static_cast<std::uint32_t>(scene.objects.size() - 1), placed, {}});
    }
  }
  EXPECT_GT(misplaced, 5);  // the scene can tell
  for (const double speed : {1.0, 0.01, 300.0}) {
    const std::vector<RayRecord> rays = {make_ray({0, 0, -1}, {0, 0, speed})};
    const RayList list = list_tracer().trace(lower(scene), rays, capacity)[0];
    ASSERT_EQ(list.hits.size(), expected.size());
    EXPECT_EQ(list.closest.t, list.hits[0].t);
    for (std::size_t i = 0; i < expected.size(); ++i) {
      EXPECT_NEAR(double(list.hits[i].t) * speed, expected[i] + 1, 1e-5 * (expected[i] + 1)) << i;
      EXPECT_EQ(is_leaving(list.hits[i]), i % 2 == 1) << i;
    }
    // The nearest one from anywhere along the row.
    for (std::size_t i = 0; i + 1 < expected.size(); ++i) {
      const double start = 0.5 * (expected[i] + expected[i + 1]);
      const std::vector<RayRecord> ray = {make_ray({0, 0, start}, {0, 0, speed})};
      const RayList next = list_tracer().trace(lower(scene), ray, capacity)[0];
      ASSERT_FALSE(next.hits.empty());
      EXPECT_NEAR(double(next.closest.t) * speed, expected[i + 1] - start,
                  1e-5 * (expected[i + 1] + 1));
      EXPECT_EQ(next.hits.size(), expected.size() - i - 1);
    }
  }
}

// A ray from so far that its rounding is larger than the solid, and planes that bound it nowhere: a
// face's point was led along a line to where those planes meet, 1e37 away.
TEST(Scenes, PolyhedraSeenFromAfarAreMetWhereTheyAre) {
  const glm::vec3 center(9.0625f, 8.4375f, 8.91458321f);
  const std::array planes = {glm::vec4(-1, 0, 0, 2.6875),
                             glm::vec4(1, 0, 0, 2.6875),
                             glm::vec4(0, -1, 0, 1.5625),
                             glm::vec4(0, 1, 0, 1.5625),
                             glm::vec4(0, 0, -1, 5.91458321),
                             glm::vec4(0, 0, 1, 134217712),
                             glm::vec4(-0.881479979, 3.45548094e-37, 0.472221404, 0.424015522),
                             glm::vec4(-1.03915141e-07, 1.22253113e-07, 1, 31952148),
                             glm::vec4(0.473405421, 0.0541034788, -0.879181504, 34.7567635)};
  PolyhedronShape shape;
  for (const glm::dvec4 plane : planes) {
    const glm::dvec3 n(plane);
    shape.normals.push_back(n);
    shape.points.push_back(glm::dvec3(center) + plane.w / glm::dot(n, n) * n);
  }
  FlatScene scene = lower_shapes({shape_of(shape)});
  // To the bit.
  const std::size_t head = std::bit_cast<std::uint32_t>(scene.leaves.at(scene.leaves.size() - 16));
  ASSERT_EQ(std::bit_cast<std::uint32_t>(scene.leaves.at(head + 3)), planes.size());
  for (int i = 0; i < 3; ++i) scene.leaves[head + static_cast<std::size_t>(i)] = center[i];
  for (std::size_t i = 0; i < planes.size(); ++i)
    for (int k = 0; k < 4; ++k)
      scene.leaves[head + 8 + 4 * i + static_cast<std::size_t>(k)] = planes[i][k];

  std::mt19937 random(5);
  std::uniform_real_distribution<double> coordinate(-1, 1);
  std::vector<RayRecord> rays;
  for (int i = 0; i < 20'000; ++i) {
    const double far = std::pow(10.0, 13 + 4 * std::abs(coordinate(random)));
    rays.push_back(make_ray(dvec3(far), dvec3(-far)));
    rays.push_back(make_ray(far * dvec3(coordinate(random), coordinate(random), coordinate(random)),
                            dvec3(0)));
    rays.back().dx = -rays.back().ox;
    rays.back().dy = -rays.back().oy;
    rays.back().dz = -rays.back().oz;
  }
  for (const int width : {8, 1}) {
    int crossings = 0;
    for (const RayList& list : list_tracer(width).trace(scene, rays, 8))
      for (const CrossingSurface& surface : list.surfaces) {
        ++crossings;
        // All corners are within 7 of the centre. A face's point is sought from within twice that
        // in every coordinate, and within 8 times along a line.
        EXPECT_LT(glm::length(vec(surface.p) - dvec3(center)), 7 * (2 * std::sqrt(3.0) + 8));
        EXPECT_TRUE(std::isfinite(surface.error));
      }
    EXPECT_GT(crossings, 10'000);
  }
}

}  // namespace
}  // namespace caplet::test::scenes_test
