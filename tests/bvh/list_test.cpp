// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Hit lists: every crossing of every primitive as the reference finds it, in order; capacity and
// overflow; ties.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <map>
#include <mutex>
#include <set>

#include "list_tracer.h"
#include "lower/geometry_pages.h"
#include "random_scene.h"
#include "reference/solver.h"

namespace caplet::test {
namespace {

using glm::dmat4;
using glm::dvec3;

constexpr double eps = 0x1p-24;
constexpr float inf = std::numeric_limits<float>::infinity();

dvec3 point(const float* p) { return {p[0], p[1], p[2]}; }

reference::Primitive reference_of(const FlatPrimitive& p) {
  const float* d = p.data;
  switch (p.shape) {
    case shape_sphere:
      return reference::Sphere{point(d), double(d[3])};
    case shape_capsule:
      return reference::Capsule{point(d), point(d + 3), double(d[6]), double(d[6])};
    case shape_tapered_capsule:
      return reference::Capsule{point(d), point(d + 3), double(d[6]), double(d[7])};
    case shape_box:
      return reference::Box{{point(d), point(d + 3)}};
    case shape_triangle:
      return reference::Triangle{point(d), point(d + 3), point(d + 6)};
    default:
      return reference::Disk{point(d), point(d + 3), double(d[6])};
  }
}

/// Primitives of the kinds above, many of them inside or across each other.
std::vector<FlatPrimitive> mixed_primitives(unsigned seed, unsigned count, float size) {
  std::vector<FlatPrimitive> out = random_scene(seed, shape_instance, count, size);
  Random random(seed + 1);
  for (FlatPrimitive& p : out)
    if (random.below(6) == 0) {
      p.shape = shape_box;
      for (int k = 0; k < 3; ++k) p.data[3 + k] = p.data[k] + random.uniform(0.1f, 1) * size;
    }
  return out;
}

/// A scene of primitives in the world and, where `placements` are given, of as many instances of
/// all of them.
struct ListScene {
  std::vector<FlatPrimitive> primitives;
  std::vector<reference::Primitive> references;
  std::vector<dmat4> object_from_world;  // empty: the world itself
  std::vector<std::uint32_t> slots;
  FlatScene flat;

  explicit ListScene(std::vector<FlatPrimitive> list, const std::vector<dmat4>& placements = {},
                     uint flags = 0)
      : primitives(std::move(list)) {
    std::vector<std::uint32_t> geometry_of;
    for (FlatPrimitive& p : primitives) {
      p.id = static_cast<std::uint32_t>(references.size());
      references.push_back(reference_of(p));
      GeometryRecord geometry{};
      geometry.shape = p.shape;
      geometry.primitive_begin = p.id;
      geometry.light_offset = geometry.normal_begin = geometry.uv_begin = geometry.surface_begin =
          geometry.uv_space = CAPLET_NONE;
      geometry.index_begin = 3 * p.id;
      flat.geometries.push_back(geometry);
      geometry_of.push_back(p.id);
      for (int k = 0; k < 3; ++k) flat.mesh_indices.push_back(0);
    }
    flat.primitive_geometry = geometry_pages(geometry_of);
    const EncodedTree tree = encode_tree(primitives, flat.nodes, flat.leaves);
    slots = tree.slots;
    flat.world.root = tree.root;
    if (placements.empty()) return;
    std::vector<FlatPrimitive> top;
    for (const dmat4& placed : placements) {
      InstanceRecord record{};
      const dmat4 inverse = glm::inverse(placed);
      dmat4 rounded(1);
      for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 4; ++c) {
          record.object_from_world[4 * r + c] = static_cast<float>(inverse[c][r]);
          record.world_from_object[4 * r + c] = static_cast<float>(placed[c][r]);
          rounded[c][r] = double(record.object_from_world[4 * r + c]);
        }
      record.root = tree.root;
      record.light_base = CAPLET_NONE;
      record.flags = flags;
      object_from_world.push_back(rounded);
      FlatPrimitive box{shape_instance, static_cast<std::uint32_t>(flat.instances.size()), {}};
      for (int k = 0; k < 3; ++k) box.data[k] = inf, box.data[3 + k] = -inf;
      for (int corner = 0; corner < 8; ++corner) {
        const dvec3 p(placed * glm::dvec4(double(corner & 1 ? tree.max[0] : tree.min[0]),
                                          double(corner & 2 ? tree.max[1] : tree.min[1]),
                                          double(corner & 4 ? tree.max[2] : tree.min[2]), 1));
        for (int k = 0; k < 3; ++k) {
          box.data[k] = std::min(box.data[k], static_cast<float>(p[k]));
          box.data[3 + k] = std::max(box.data[3 + k], static_cast<float>(p[k]));
        }
      }
      flat.instances.push_back(record);
      top.push_back(box);
    }
    flat.world.root = encode_tree(top, flat.nodes, flat.leaves).root;
  }

  std::size_t places() const { return std::max<std::size_t>(1, object_from_world.size()); }
};

double size_of(const reference::Primitive& p) { return 3 * reference::bounding_ball(p).radius; }

/// Primitives are numbered as they are given, and all instances have the object number 0.
bool before(const ListScene& scene, const HitRecord& a, const HitRecord& b) {
  const auto key = [&](const HitRecord& hit) {
    return std::tuple(hit.t, !is_leaving(hit),
                      std::bit_cast<std::uint32_t>(scene.flat.leaves[hit.slot]), hit.instance,
                      hit.surface);
  };
  return key(a) < key(b);
}

struct Tally {
  std::mutex mutex;
  std::size_t crossings = 0, tangent = 0, failures = 0;
  void fail(const std::string& what, const RayRecord& r) {
    const std::lock_guard lock(mutex);
    if (failures++ < 5)
      ADD_FAILURE() << what
                    << fmt::format("\nray {:a} {:a} {:a}  {:a} {:a} {:a}", r.ox, r.oy, r.oz, r.dx,
                                   r.dy, r.dz);
  }
};

/// The whole list of a ray against the crossings of each primitive by itself.
void check_list(const ListScene& scene, const RayRecord& record, const RayList& list,
                Tally& tally) {
  if (list.overflow) return tally.fail("the list overflows", record);
  if (list.any != !list.hits.empty()) tally.fail("any hit is not whether the list has one", record);
  for (std::size_t k = 0; k + 1 < list.hits.size(); ++k)
    if (!before(scene, list.hits[k], list.hits[k + 1]))
      tally.fail(fmt::format("crossings {} and {} are out of order", k, k + 1), record);
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<HitRecord>> by_primitive;
  for (const HitRecord& hit : list.hits) {
    if (!(hit.t > record.t_min && hit.t < record.t_max))
      tally.fail(fmt::format("t {} is out of range", hit.t), record);
    by_primitive[{hit.slot, hit.instance}].push_back(hit);
  }
  std::size_t accounted = 0;
  for (std::size_t place = 0; place < scene.places(); ++place) {
    reference::Ray ray{{record.ox, record.oy, record.oz},
                       {record.dx, record.dy, record.dz},
                       record.t_min,
                       record.t_max};
    double rounding = 0;
    if (!scene.object_from_world.empty()) {
      const dmat4& m = scene.object_from_world[place];
      // The transform to the object rounds by 4 eps of its terms.
      double terms = glm::length(dvec3(m[3]));
      for (int k = 0; k < 3; ++k) terms += glm::length(dvec3(m[k])) * glm::length(ray.origin);
      rounding = 4 * eps * terms;
      ray.origin = dvec3(m * glm::dvec4(ray.origin, 1));
      ray.direction = dvec3(m * glm::dvec4(ray.direction, 0));
    }
    for (std::size_t i = 0; i < scene.primitives.size(); ++i) {
      const reference::Primitive& reference = scene.references[i];
      const std::uint32_t instance =
          scene.object_from_world.empty() ? CAPLET_NONE : static_cast<std::uint32_t>(place);
      const auto found = by_primitive.find({scene.slots[i], instance});
      const std::vector<HitRecord> hits =
          found == by_primitive.end() ? std::vector<HitRecord>{} : found->second;
      accounted += hits.size();
      std::vector<reference::Crossing> expected;
      for (const reference::Crossing& c : reference::crossings(reference, ray))
        if (c.t > ray.t_min && c.t < ray.t_max) expected.push_back(c);
      if (hits.empty() && expected.empty()) continue;
      const double distance = glm::length(ray.origin - reference::bounding_ball(reference).center);
      const double bound = 17 * eps * (distance + size_of(reference)) + rounding;
      const auto value = [&](double t) {
        return reference::value(reference, ray.origin + t * ray.direction);
      };
      bool same = hits.size() == expected.size();
      for (std::size_t k = 0; same && k < hits.size(); ++k) {
        same = is_leaving(hits[k]) == expected[k].leaving;
        // The same crossing: from one parameter to the other the ray stays at the surface.
        if (same && std::abs(value(0.5 * (double(hits[k].t) + expected[k].t))) > 2 * bound)
          tally.fail(fmt::format("primitive {} is crossed at {}, the reference says {}", i,
                                 hits[k].t, expected[k].t),
                     record);
      }
      {
        const std::lock_guard lock(tally.mutex);
        tally.crossings += hits.size();
        tally.tangent += !same;
      }
      if (same || reference::referee(reference, ray, bound) == reference::Verdict::tangent)
        continue;
      // Begins or ends at the surface.
      if (std::abs(value(ray.t_min)) <= bound ||
          (std::isfinite(ray.t_max) && std::abs(value(ray.t_max)) <= bound))
        continue;
      tally.fail(fmt::format("primitive {} (shape {}): {} crossings, the reference has {}", i,
                             scene.primitives[i].shape, hits.size(), expected.size()),
                 record);
    }
  }
  if (accounted != list.hits.size()) tally.fail("crossings of no primitive", record);
}

void check_lists(const ListScene& scene, const std::vector<RayRecord>& rays, int width,
                 std::size_t least) {
  const auto lists = list_tracer(width).trace(scene.flat, rays, 512);
  Tally tally;
  tbb::parallel_for(std::size_t(0), rays.size(),
                    [&](std::size_t i) { check_list(scene, rays[i], lists[i], tally); });
  std::printf("%zu rays, %zu crossings, %zu primitives touched or begun at, %zu failures\n",
              rays.size(), tally.crossings, tally.tangent, tally.failures);
  EXPECT_EQ(tally.failures, 0u);
  EXPECT_GT(tally.crossings, least);
  EXPECT_LT(tally.tangent, tally.crossings / 200);
}

class HitLists : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Widths, HitLists, testing::Values(8, 1));

TEST_P(HitLists, HoldEveryCrossing) {
  const ListScene scene(mixed_primitives(1, 150, 0.8f));
  check_lists(scene, random_rays(2, 1500 * test_scale()), GetParam(), 10000);
}

TEST_P(HitLists, WithinTheRaysInterval) {
  const ListScene scene(mixed_primitives(3, 100, 0.8f));
  auto rays = random_rays(4, 1000 * test_scale());
  Random random(5);
  for (RayRecord& r : rays) {
    const float speed = std::hypot(r.dx, r.dy, r.dz);
    r.t_min = random.uniform(0, 2) / speed;
    r.t_max = r.t_min + random.uniform(0, 2) / speed;
  }
  check_lists(scene, rays, GetParam(), 3000);
}

TEST_P(HitLists, ThroughOverlappingInstances) {
  Random random(6);
  std::vector<dmat4> placements;
  for (int i = 0; i < 12; ++i) {
    const auto u = [&](float a, float b) { return double(random.uniform(a, b)); };
    dmat4 m = glm::translate(dmat4(1), dvec3(u(-1, 1), u(-1, 1), u(-1, 1)));
    m = glm::rotate(m, u(0, 6), glm::normalize(dvec3(u(-1, 1), u(-1, 1), u(0.1f, 1))));
    placements.push_back(
        glm::scale(m, dvec3(u(0.5f, 2), u(0.5f, 2), u(0.5f, 2) * (i % 2 == 0 ? 1 : -1))));
  }
  const ListScene scene(mixed_primitives(7, 25, 0.8f), placements);
  check_lists(scene, random_rays(8, 600 * test_scale()), GetParam(), 5000);
}

bool same_hit(const HitRecord& a, const HitRecord& b) {
  return a.t == b.t && a.slot == b.slot && a.instance == b.instance && a.surface == b.surface;
}

TEST_P(HitLists, ShortListsAreTheNearestAndSaySo) {
  const ListScene scene(mixed_primitives(11, 200, 0.6f));
  const auto rays = random_rays(12, 2000);
  const auto whole = list_tracer(GetParam()).trace(scene.flat, rays, 512);
  for (const std::uint32_t capacity : {0u, 1u, 2u, 3u, 7u, 20u}) {
    const auto lists = list_tracer(GetParam()).trace(scene.flat, rays, capacity);
    std::size_t overflows = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      EXPECT_EQ(lists[i].overflow, whole[i].hits.size() > capacity);
      ASSERT_EQ(lists[i].hits.size(), std::min<std::size_t>(capacity, whole[i].hits.size()));
      for (std::size_t k = 0; k < lists[i].hits.size(); ++k)
        EXPECT_TRUE(same_hit(lists[i].hits[k], whole[i].hits[k]));
      overflows += lists[i].overflow;
    }
    EXPECT_GT(overflows, capacity < 20 ? 100u : 0u);
  }
}

TEST_P(HitLists, FirstIsTheNearestHit) {
  const ListScene scene(mixed_primitives(13, 400, 0.4f));
  const auto rays = random_rays(14, 20000);
  std::size_t hits = 0, other = 0;
  for (const RayList& list : list_tracer(GetParam()).trace(scene.flat, rays, 1)) {
    if (list.closest.slot == CAPLET_NONE && list.hits.empty()) continue;
    ++hits;
    other += list.hits.empty() || !same_hit(list.closest, list.hits[0]);
  }
  EXPECT_GT(hits, 5000u);
  EXPECT_EQ(other, 0u);
}

// Touching, nested and equal solids, by hand.
FlatPrimitive solid_box(dvec3 a, dvec3 b) {
  return {shape_box, 0, {float(a.x), float(a.y), float(a.z), float(b.x), float(b.y), float(b.z)}};
}
FlatPrimitive solid_sphere(dvec3 c, double r) {
  return {shape_sphere, 0, {float(c.x), float(c.y), float(c.z), float(r)}};
}

struct Expected {
  double t;
  bool leaving;
  std::size_t primitive;
};

void expect_list(const ListScene& scene, const RayRecord& ray,
                 const std::vector<Expected>& expected, int width) {
  const RayList list = list_tracer(width).trace(scene.flat, std::span(&ray, 1), 64)[0];
  ASSERT_EQ(list.hits.size(), expected.size());
  for (std::size_t k = 0; k < expected.size(); ++k) {
    EXPECT_NEAR(double(list.hits[k].t), expected[k].t, 1e-5) << k;
    EXPECT_EQ(is_leaving(list.hits[k]), expected[k].leaving) << k;
    EXPECT_EQ(list.hits[k].slot, scene.slots[expected[k].primitive]) << k;
  }
}

TEST_P(HitLists, TouchingBoxesAreLeftBeforeTheNextIsEntered) {
  const ListScene scene({solid_box({1, 0, 0}, {2, 1, 1}), solid_box({0, 0, 0}, {1, 1, 1}),
                         solid_box({2, 0, 0}, {3, 1, 1})});
  expect_list(
      scene, make_ray({-1, 0.3, 0.4}, {1, 0, 0}),
      {{1, false, 1}, {2, true, 1}, {2, false, 0}, {3, true, 0}, {3, false, 2}, {4, true, 2}},
      GetParam());
  expect_list(
      scene, make_ray({4, 0.3, 0.4}, {-2, 0, 0}),
      {{0.5, false, 2}, {1, true, 2}, {1, false, 0}, {1.5, true, 0}, {1.5, false, 1}, {2, true, 1}},
      GetParam());
  // Obliquely, at any angle, they are left and entered at the same t.
  Random random(15);
  std::vector<RayRecord> rays;
  for (int i = 0; i < 5000; ++i)
    rays.push_back(make_ray({-1, double(random.uniform(-1, 2)), double(random.uniform(-1, 2))},
                            {double(random.uniform(0.2f, 2)), double(random.uniform(-1, 1)),
                             double(random.uniform(-1, 1))}));
  std::size_t through = 0;
  for (const RayList& list : list_tracer(GetParam()).trace(scene.flat, rays, 16)) {
    for (std::size_t k = 0; k < list.hits.size(); ++k)
      EXPECT_EQ(is_leaving(list.hits[k]), k % 2 == 1);
    through += list.hits.size() > 2;
  }
  EXPECT_GT(through, 200u);
}

TEST_P(HitLists, NestedSolidsAndABeginningInside) {
  const ListScene scene(
      {solid_sphere({0, 0, 0}, 3), solid_sphere({0, 0, 0}, 1), solid_sphere({0, 0, 0}, 2)});
  expect_list(
      scene, make_ray({-5, 0, 0}, {1, 0, 0}),
      {{2, false, 0}, {3, false, 2}, {4, false, 1}, {6, true, 1}, {7, true, 2}, {8, true, 0}},
      GetParam());
  expect_list(scene, make_ray({0, 0, 0}, {0, 0, 0.5}), {{2, true, 1}, {4, true, 2}, {6, true, 0}},
              GetParam());
  expect_list(scene, make_ray({0, 1.5, 0}, {0, -1, 0}),
              {{0.5, false, 1}, {2.5, true, 1}, {3.5, true, 2}, {4.5, true, 0}}, GetParam());
}

TEST_P(HitLists, OverlappingAndEqualSolids) {
  const ListScene scene(
      {solid_sphere({0, 0, 0}, 1), solid_sphere({1, 0, 0}, 1), solid_sphere({0, 0, 0}, 1)});
  expect_list(
      scene, make_ray({-2, 0, 0}, {1, 0, 0}),
      {{1, false, 0}, {1, false, 2}, {2, false, 1}, {3, true, 0}, {3, true, 2}, {4, true, 1}},
      GetParam());
}

TEST_P(HitLists, WhatIsTouchedIsEnteredBeforeItIsLeft) {
  // At one point, to the bit: entered there and left at the next float.
  const FlatPrimitive capsule{shape_capsule, 0, {-1, 0, 0, 1, 0, 0, 1}};
  for (const FlatPrimitive& solid : {solid_sphere({0, 0, 0}, 1), capsule}) {
    const ListScene scene({solid});
    const std::vector<RayRecord> rays = {make_ray({0, 1, -2}, {0, 0, 1})};
    const auto hits = list_tracer(GetParam()).trace(scene.flat, rays, 8)[0].hits;
    ASSERT_EQ(hits.size(), 2u);
    EXPECT_EQ(hits[0].t, 2);
    EXPECT_FALSE(is_leaving(hits[0]));
    EXPECT_EQ(hits[1].t, std::nextafter(2.0f, 3.0f));
    EXPECT_TRUE(is_leaving(hits[1]));
  }
}

TEST_P(HitLists, SidesThatAreNotSeenAreNotListed) {
  const dmat4 placed = glm::translate(dmat4(1), dvec3(0.5, 0, 0));
  const auto primitives = mixed_primitives(17, 60, 0.8f);
  const auto rays = random_rays(18, 1500);
  const auto all = list_tracer(GetParam()).trace(ListScene(primitives, {placed}).flat, rays, 512);
  for (const uint flag : {CAPLET_INSTANCE_NO_LEAVING, CAPLET_INSTANCE_NO_ENTERING}) {
    const auto some =
        list_tracer(GetParam()).trace(ListScene(primitives, {placed}, flag).flat, rays, 512);
    std::size_t seen = 0, hidden = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      std::size_t k = 0;
      for (const HitRecord& hit : all[i].hits) {
        if (is_leaving(hit) == (flag == CAPLET_INSTANCE_NO_LEAVING)) {
          ++hidden;
          continue;
        }
        ASSERT_LT(k, some[i].hits.size());
        EXPECT_TRUE(same_hit(hit, some[i].hits[k]));
        ++k;
        ++seen;
      }
      EXPECT_EQ(k, some[i].hits.size());
    }
    EXPECT_GT(seen, 1000u);
    EXPECT_GT(hidden, 1000u);
  }
}

/// A closed surface of triangles wound outward: the unit octahedron's faces, divided and put on the
/// sphere.
std::vector<FlatPrimitive> ball_of_triangles(int levels) {
  std::vector<std::array<dvec3, 3>> faces;
  for (int x = -1; x <= 1; x += 2)
    for (int y = -1; y <= 1; y += 2)
      for (int z = -1; z <= 1; z += 2) {
        std::array<dvec3, 3> f = {dvec3(x, 0, 0), dvec3(0, y, 0), dvec3(0, 0, z)};
        if (x * y * z < 0) std::swap(f[1], f[2]);
        faces.push_back(f);
      }
  for (int level = 0; level < levels; ++level) {
    std::vector<std::array<dvec3, 3>> next;
    for (const auto& [a, b, c] : faces) {
      const dvec3 ab = glm::normalize(a + b), bc = glm::normalize(b + c),
                  ca = glm::normalize(c + a);
      next.insert(next.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    faces = next;
  }
  std::vector<FlatPrimitive> out;
  for (const auto& f : faces) {
    FlatPrimitive p{shape_triangle, 0, {}};
    for (std::size_t v = 0; v < 3; ++v)
      for (int k = 0; k < 3; ++k)
        p.data[3 * v + static_cast<std::size_t>(k)] = static_cast<float>(f[v][k]);
    out.push_back(p);
  }
  return out;
}

TEST_P(HitLists, ClosedMeshesAreEnteredAndLeft) {
  const ListScene scene(ball_of_triangles(3));
  Random random(19);
  std::vector<RayRecord> rays;
  std::vector<bool> begins_inside;
  const auto u = [&](float a, float b) { return double(random.uniform(a, b)); };
  for (int i = 0; i < 20000; ++i) {
    const bool inside = i % 2 == 0;
    const dvec3 o =
        (inside ? 0.9 * u(0, 1) : u(1.2f, 4)) * glm::normalize(dvec3(u(-1, 1), u(-1, 1), u(-1, 1)));
    rays.push_back(make_ray(
        o, inside ? dvec3(u(-1, 1), u(-1, 1), u(-1, 1)) : dvec3(u(-1, 1), u(-1, 1), u(-1, 1)) - o));
    begins_inside.push_back(inside);
  }
  const auto lists = list_tracer(GetParam()).trace(scene.flat, rays, 16);
  std::size_t shared = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    // Edges belong to both faces: their crossings come twice, at the same place. Once each, they
    // take turns.
    std::vector<bool> turns;
    float last = -1;
    for (const HitRecord& hit : lists[i].hits) {
      if (!turns.empty() && is_leaving(hit) == turns.back() && hit.t - last <= 1e-5f) {
        ++shared;
        continue;
      }
      turns.push_back(is_leaving(hit));
      last = hit.t;
    }
    for (std::size_t k = 0; k < turns.size(); ++k)
      EXPECT_EQ(turns[k], begins_inside[i] == (k % 2 == 0)) << i;
    EXPECT_EQ(turns.size() % 2, begins_inside[i] ? 1u : 0u) << i;
  }
  EXPECT_LT(shared, 40u);
}

TEST_P(HitLists, UselessRaysHaveNone) {
  const ListScene scene(mixed_primitives(20, 50, 0.8f));
  const float nan = std::numeric_limits<float>::quiet_NaN();
  std::vector<RayRecord> rays;
  for (const float bad : {nan, inf, -inf}) {
    rays.push_back({bad, 0, 0, 0, 0, 0, 1, inf});
    rays.push_back({0, 0, 0, 0, bad, 0, 1, inf});
  }
  rays.push_back({0, 0, 0, 0, 0, 0, 0, inf});
  rays.push_back({0, 0, 0, 2, 1, 0, 0, 1});
  rays.push_back({0, 0, 0, 0, 1, 0, 0, nan});
  for (const RayList& list : list_tracer(GetParam()).trace(scene.flat, rays, 8)) {
    EXPECT_TRUE(list.hits.empty());
    EXPECT_FALSE(list.overflow);
  }
}

}  // namespace
}  // namespace caplet::test
