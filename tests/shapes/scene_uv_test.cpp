// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Texture coordinates of the kernels against the witness's, on scenes of all shapes under all kinds of transforms.
// CAPLET_TEST_SCALE=N tries N times as many scenes.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <map>
#include <variant>

#include "lower/identity.h"
#include "random_scene.h"
#include "reference/scene_witness.h"
#include "render/query.h"
#include "render_scene.h"

namespace caplet::test {
namespace {

using glm::dvec2;
using glm::dvec3;

constexpr double eps = 0x1p-24;

int scale_of_test() {
  const char* text = std::getenv("CAPLET_TEST_SCALE");
  return text ? std::clamp(std::atoi(text), 1, 1000) : 1;
}

RayRecord to_record(const dvec3& o, const dvec3& d) {
  return {static_cast<float>(o.x), static_cast<float>(o.y), static_cast<float>(o.z), 0,
          static_cast<float>(d.x), static_cast<float>(d.y), static_cast<float>(d.z), INFINITY};
}

std::vector<RayRecord> random_rays(std::uint32_t seed, int count) {
  SceneMaker make(seed);
  std::vector<RayRecord> out;
  for (int i = 0; i < count; ++i) {
    const dvec3 o = make.uniform(0, 12) * make.direction();
    out.push_back(to_record(o, 5 * make.uniform(0, 1) * make.direction() - o));
  }
  return out;
}

struct Count {
  int hits = 0, wild = 0, failures = 0;
};
using Counts = std::map<std::size_t, Count>;  // by alternative of Shape::geometry

/// The witness's uv where the kernels say their point is. That point is within `error` of the surface, and the numbers of the
/// shape it is on are rounded, to 8 eps of its place and size, before: uv may differ by as much as it does over such a distance
/// along each axis, which is all of it at poles and seams, and by the roundings of a handful of operations on numbers up to 2.5.
void check(const Scene& scene, const reference::SceneWitness& witness, const RayRecord& record, const PickRecord& pick,
           Counts& counts) {
  const reference::Ray ray{{record.ox, record.oy, record.oz}, {record.dx, record.dy, record.dz}, 0, HUGE_VAL};
  const Identity identity = identity_of(scene, pick);
  const reference::SceneHit* best = nullptr;
  const auto hits = witness.all(ray);
  for (const reference::SceneHit& hit : hits) {
    const bool placed = hit.instance != reference::no_instance;
    const Shape& shape = placed ? scene.objects[hit.object].shapes[hit.shape] : scene.shapes[hit.shape];
    if (&shape != identity.shape || placed != identity.instance.has_value() || (placed && hit.instance != *identity.instance))
      continue;
    if (hit.primitive != pick.primitive || hit.surface != pick.surface) continue;
    if (!best || std::abs(hit.t - double(pick.t)) < std::abs(best->t - double(pick.t))) best = &hit;
  }
  if (!best) return;  // grazing, or at an edge: another test's business
  const dvec3 point(pick.point[0], pick.point[1], pick.point[2]);
  const double reach = double(pick.error) + 8 * eps * (glm::length(point) + 4);
  const dvec2 expected = witness.uv(*best, point), found(pick.u, pick.v);
  dvec2 low = expected, high = expected;
  for (int k = 0; k < 6; ++k) {
    dvec3 moved = point;
    moved[k / 2] += k % 2 == 0 ? reach : -reach;
    const dvec2 uv = witness.uv(*best, moved);
    low = glm::min(low, uv);
    high = glm::max(high, uv);
  }
  const dvec2 allowed = (high - low) + 16 * eps * 2.5, off = glm::abs(found - expected);
  Count& count = counts[identity.shape->geometry.index()];
  ++count.hits;
  count.wild += std::max(allowed.x, allowed.y) > 0.01;
  if (off.x <= allowed.x && off.y <= allowed.y) return;
  if (++count.failures <= 3)
    ADD_FAILURE() << fmt::format(
        "geometry {} instance {} surface {}: uv {} {}, the witness says {} {}, allowed {} {}\nat {} {} {}",
        identity.shape->geometry.index(), static_cast<int>(best->instance), pick.surface, found.x, found.y, expected.x,
        expected.y, allowed.x, allowed.y, point.x, point.y, point.z);
}

void report(const Counts& counts, int least) {
  for (const auto& [kind, count] : counts) {
    std::printf("geometry %zu: %d hits, %d of no meaning, %d failures\n", kind, count.hits, count.wild, count.failures);
    EXPECT_EQ(count.failures, 0) << kind;
    EXPECT_GE(count.hits, least) << kind;
    EXPECT_LE(count.wild, count.hits / 100 + 5) << kind;
  }
}

void compare(const Scene& scene, std::uint32_t seed, int rays, Counts& counts) {
  const reference::SceneWitness witness(scene);
  const std::vector<RayRecord> records = random_rays(seed, rays);
  Query query(lower(scene), test_device());
  const HitLists lists = query.all(records, 200);
  for (std::size_t i = 0; i < records.size(); ++i)
    for (std::size_t k = lists.begin[i]; k < lists.begin[i + 1]; ++k)
      check(scene, witness, records[i], lists.crossings[k], counts);
}

TEST(SceneUv, OfAllShapesIsTheWitnesss) {
  Counts counts;
  for (int i = 0; i < 4 * scale_of_test(); ++i)
    compare(random_scene(700 + static_cast<std::uint32_t>(i)), 800 + static_cast<std::uint32_t>(i), 4000, counts);
  EXPECT_EQ(counts.size(), std::variant_size_v<decltype(Shape::geometry)>);
  report(counts, 500);
}

// Faces that the mesh's normals turn over keep their uvs; capsules of one point have the z axis of their own space.
TEST(SceneUv, OfTurnedFacesAndBalls) {
  SceneMaker make(5);
  Scene scene;
  scene.materials.push_back({DiffuseMaterial{}, "", {}});
  for (int i = 0; i < 24; ++i) {
    const glm::vec3 a(make.direction()), b(make.direction()), c(make.direction()), d(make.direction());
    const std::vector<glm::vec3> normals(4, glm::vec3(make.direction()));
    Shape shape;
    shape.world_from_object = make.placement(4);
    if (i % 3 == 0) shape.geometry = TriangleMeshShape{{a, b, c, d}, {{0, 1, 2}, {1, 2, 3}}, normals, {}};
    if (i % 3 == 1) shape.geometry = BilinearMeshShape{{a, b, c, d}, {{0, 1, 2, 3}}, normals, {}};
    if (i % 3 == 2) shape.geometry = CapsulesShape{{a, b}, {a, b + 0.1f * c}, {0.6f, 0.5f}, {0.3f, 0.9f}, {}};
    scene.shapes.push_back(shape);
  }
  Counts counts;
  compare(scene, 6, 10000, counts);
  report(counts, 500);
}

}  // namespace
}  // namespace caplet::test
