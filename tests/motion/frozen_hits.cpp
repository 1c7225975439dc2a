// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "frozen_hits.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>
#include <random>

#include "lower/identity.h"
#include "lower/lower.h"
#include "reference/scene_reference.h"
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

BesideReference beside_reference(const Scene& scene, const std::vector<float>& times,
                                 const std::function<std::vector<RayRecord>(unsigned seed)>& rays) {
  const FlatScene flat = lower(scene);
  BesideReference out;
  for (const Encoding encoding : {Encoding::wide, Encoding::single}) {
    Query query(flat, test_device(encoding));
    for (std::size_t k = 0; k < times.size(); ++k) {
      const FilmSettings& film = scene.view.film;
      const Scene frozen =
          frozen_at(scene, film.shutter_open + double{times[k]} * film.exposure_time);
      EXPECT_FALSE(moves(frozen));
      const reference::SceneReference reference(frozen);
      const std::vector<RayRecord> some = rays(100 + static_cast<unsigned>(k));
      const auto picks = query.closest(some, std::vector<float>(some.size(), times[k]));
      for (std::size_t i = 0; i < some.size(); ++i) {
        const RayRecord& ray = some[i];
        const PickRecord& pick = picks[i];
        const reference::Ray exact{{ray.ox, ray.oy, ray.oz}, {ray.dx, ray.dy, ray.dz}};
        const auto hit = reference.closest(exact);
        out.hits += hit ? 1 : 0;
        if (hit.has_value() != std::isfinite(pick.t)) {
          ++out.apart;
          continue;
        }
        if (!hit) continue;
        const bool placed = hit->instance != reference::no_instance;
        const Shape* shape =
            placed ? &frozen.objects[hit->object].shapes[hit->shape] : &frozen.shapes[hit->shape];
        const double length = glm::length(exact.direction);
        const dvec3 normal(pick.normal[0], pick.normal[1], pick.normal[2]);
        const double cosine = std::abs(glm::dot(normal, exact.direction)) / length;
        const double scale = glm::length(exact.origin) + pick.t * length;
        // The bound of the point, as much for t, the way to its place (24 roundings), and what the
        // rounded time moves it by: 2^-24 of 1.25 seconds at speeds up to 12.
        const double bound = 2 * double{pick.error} + 24 * 0x1p-24 * scale + 2 * 15 * 0x1p-24;
        const dvec3 at = exact.origin + double{pick.t} * exact.direction;
        const double off =
            std::max(std::abs(hit->t - pick.t) * length * cosine,
                     glm::length(dvec3(pick.point[0], pick.point[1], pick.point[2]) - at));
        EXPECT_LT(pick.error, 1e-4) << "ray " << i << " at " << times[k];
        if (identity_of(frozen, pick).shape == shape && off <= bound) {
          ++out.near;
        } else {
          ++out.apart;  // a nearer surface may be touched by one of them alone
          EXPECT_LT(cosine, 0.1) << "ray " << i << " at " << times[k] << " is off by " << off
                                 << " of " << bound;
        }
      }
    }
  }
  return out;
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
