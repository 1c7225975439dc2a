// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "frozen_hits.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <glm/geometric.hpp>
#include <random>

#include "lower/lower.h"
#include "render/query.h"
#include "render_scene.h"
#include "scene/frozen.h"
#include "shared/shapes.h"
#include "support/rays.h"
#include "support/test_scale.h"

namespace caplet::test {

namespace {

using glm::dvec3;

std::vector<RayRecord> random_rays(std::size_t count, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto in_cube = [&] { return dvec3(unit(random), unit(random), unit(random)); };
  std::vector<RayRecord> out;
  for (std::size_t i = 0; i < count; ++i) {
    const dvec3 o = 9.0 * in_cube();
    out.push_back(make_ray(o, 3.0 * in_cube() - o));
  }
  return out;
}

/// The bits of what a ray sees, but for bounds, which are wider for what moves, and materials.
std::vector<std::uint32_t> seen(const PickRecord& pick) {
  std::vector<std::uint32_t> out{pick.object, pick.shape, pick.primitive, pick.surface,
                                 pick.leaving};
  for (const float value : {pick.t, pick.u, pick.v, pick.point[0], pick.point[1], pick.point[2],
                            pick.normal[0], pick.normal[1], pick.normal[2]})
    out.push_back(std::bit_cast<std::uint32_t>(value));
  return out;
}

}  // namespace

OffReference off_reference(const PickRecord& pick, const reference::Ray& ray, double t) {
  const double length = glm::length(ray.direction);
  const dvec3 normal(pick.normal[0], pick.normal[1], pick.normal[2]);
  const double cosine = std::abs(glm::dot(normal, ray.direction)) / length;
  const double scale = glm::length(ray.origin) + pick.t * length;
  // The bound of the point, as much for t, the way to its place (24 roundings), and what the
  // rounded time moves it by: 2^-24 of 1.25 seconds at speeds up to 12.
  const double bound = 2 * double{pick.error} + 24 * 0x1p-24 * scale + 2 * 15 * 0x1p-24;
  return {std::abs(t - pick.t) * length * cosine, bound, cosine};
}

void expect_hits_of_frozen(const Scene& scene, int moving_kind,
                           std::initializer_list<int> still_kinds) {
  const FlatScene flat = lower(scene);
  ASSERT_TRUE(flat.moves());
  ASSERT_NE(flat.shapes & shape_bit(static_cast<std::uint32_t>(moving_kind)), 0u);
  const auto count = static_cast<std::size_t>(4000 * test_scale());
  const std::vector<RayRecord> rays = random_rays(count, 1);
  for (const Encoding encoding : {Encoding::wide, Encoding::single}) {
    Query moving(flat, test_device(encoding));
    for (const float time : {0.0f, 0.2f, 0.217f, 0.5f, 0.9333f, 1.0f}) {
      // The instance still moves, and is at the same place to the bit.
      Scene frozen = frozen_at(scene, 0.5 + 1.5 * double{time});
      for (std::size_t i = 0; i < scene.instances.size(); ++i)
        frozen.instances[i] = scene.instances[i];
      const FlatScene still_flat = lower(frozen);
      ASSERT_EQ(still_flat.shapes & shapes_with(trait_moves), 0u);
      for (const int kind : still_kinds)
        ASSERT_NE(still_flat.shapes & shape_bit(static_cast<std::uint32_t>(kind)), 0u);
      Query still(still_flat, test_device(encoding));
      const std::vector<float> times(count, time);
      const auto found = moving.closest(rays, times), expected = still.closest(rays, times);
      std::size_t hits = 0;
      for (std::size_t i = 0; i < count; ++i) {
        ASSERT_EQ(seen(found[i]), seen(expected[i])) << "ray " << i << " at " << time;
        hits += std::isfinite(found[i].t) && found[i].object != 0 ? 1 : 0;
      }
      EXPECT_GT(hits, count / 4);
      const HitLists lists = moving.all(rays, 64, times), all = still.all(rays, 64, times);
      ASSERT_EQ(lists.begin, all.begin);
      for (std::size_t i = 0; i < lists.crossings.size(); ++i) {
        ASSERT_EQ(lists.crossings[i].t, all.crossings[i].t);
        ASSERT_EQ(lists.crossings[i].leaving, all.crossings[i].leaving);
      }
    }
  }
}

}  // namespace caplet::test
