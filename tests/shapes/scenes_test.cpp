// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Whole scenes of all shapes, lowered, against the scene witness: what is hit, in which order, named by which object, primitive,
// surface and material. CAPLET_TEST_SCALE=N tries N times as many scenes.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/matrix.hpp>
#include <map>
#include <mutex>
#include <random>

#include "list_tracer.h"
#include "random_scene.h"
#include "reference/from_scene.h"
#include "reference/scene_witness.h"
#include "shared/kinds.h"

namespace caplet::test {
namespace {

using glm::dmat4;
using glm::dvec3;

constexpr double eps = 0x1p-24;
constexpr std::uint32_t capacity = 200;

const ListTracer& tracer(int width = 8) {
  static const Device device = Device::choose("");
  static const ListTracer wide(device, 8), scalar(device, 1);
  return width == 8 ? wide : scalar;
}

int scale_of_test() {
  const char* text = std::getenv("CAPLET_TEST_SCALE");
  return text ? std::clamp(std::atoi(text), 1, 1000) : 1;
}

std::vector<RayRecord> random_rays(std::uint32_t seed, int count) {
  SceneMaker make(seed);
  std::vector<RayRecord> out;
  for (int i = 0; i < count; ++i) {
    const dvec3 o = make.uniform(0, 12) * make.direction();
    const dvec3 d = make.below(8) == 0 ? dvec3(0, 0, 1) : 5 * make.uniform(0, 1) * make.direction() - o;
    out.push_back(list_ray(o, d * std::pow(10.0, make.uniform(-1, 1))));
  }
  return out;
}

using Name = std::array<std::uint32_t, 3>;  // instance, shape, primitive

Name name_of(const reference::SceneHit& hit) { return {hit.instance, hit.shape, hit.primitive}; }

Name name_of(const Scene& scene, const FlatScene& flat, const HitRecord& hit) {
  const std::uint32_t primitive = std::bit_cast<std::uint32_t>(flat.leaves[hit.slot]);
  const GeometryRecord& geometry = flat.geometries[flat.primitive_geometry[primitive]];
  const auto world = static_cast<std::uint32_t>(scene.shapes.size());
  const std::uint32_t placed = hit.instance == CAPLET_NONE ? CAPLET_NONE : flat.instances[hit.instance].object;
  // Shapes of objects are numbered behind those of the world.
  if (placed == CAPLET_NONE) return {reference::no_instance, geometry.object, primitive - geometry.primitive_begin};
  return {placed - world, geometry.object - world, primitive - geometry.primitive_begin};
}

/// A primitive of the scene in its own space.
struct Placed {
  reference::Primitive primitive;
  dmat4 object_from_world;
  const Shape* shape;
};

std::map<Name, Placed> placed_of(const Scene& scene) {
  std::map<Name, Placed> out;
  const auto add = [&](const Shape& shape, const dmat4& m, std::uint32_t instance, std::uint32_t number) {
    std::uint32_t k = 0;
    for (const reference::Primitive& primitive : reference::primitives_of(shape))
      out[{instance, number, k++}] = {primitive, glm::inverse(m), &shape};
  };
  for (std::uint32_t i = 0; i < scene.shapes.size(); ++i)
    add(scene.shapes[i], scene.shapes[i].world_from_object, reference::no_instance, i);
  for (std::uint32_t j = 0; j < scene.instances.size(); ++j) {
    const Object& object = scene.objects[scene.instances[j].object];
    for (std::uint32_t i = 0; i < object.shapes.size(); ++i)
      add(object.shapes[i], scene.instances[j].world_from_object * object.shapes[i].world_from_object, j, i);
  }
  return out;
}

/// The ray in the primitive's space, and a bound there: twice the kernels' own (docs/numerics.md) and 8 eps of the terms of the
/// ways there, those that are baked into the primitive and those of instances.
struct Local {
  const Placed* placed;
  reference::Ray ray;
  double bound;
  double value(double t) const { return reference::value(placed->primitive, ray.origin + t * ray.direction); }
  /// Where the ray begins at the surface, touches it or passes a rim; or, of csg shapes, goes through a wall or gap thinner than
  /// the bounds of both its sides.
  bool excused() const {
    if (std::abs(value(0)) <= bound || std::abs(reference::margin(placed->primitive, ray)) <= bound) return true;
    if (!std::holds_alternative<reference::Csg>(placed->primitive)) return false;
    const auto crossings = reference::crossings(placed->primitive, ray);
    for (std::size_t i = 0; i + 1 < crossings.size(); ++i) {
      double deepest = 0;
      for (int k = 1; k < 64; ++k)
        deepest = std::max(deepest, std::abs(value(crossings[i].t + (crossings[i + 1].t - crossings[i].t) * k / 64)));
      if (deepest <= 2 * bound) return true;
    }
    return false;
  }
};

Local local_of(const Placed& placed, const reference::Ray& ray) {
  const dmat4& m = placed.object_from_world;
  Local out{&placed, {dvec3(m * glm::dvec4(ray.origin, 1)), dvec3(m * glm::dvec4(ray.direction, 0)), 0, HUGE_VAL}, 0};
  const reference::Ball ball = reference::bounding_ball(placed.primitive);
  double columns = 0, back = 0;
  const dmat4 inverse = glm::inverse(m);
  for (int c = 0; c < 3; ++c) {
    columns += glm::length(dvec3(m[c]));
    back += glm::length(dvec3(inverse[c]));
  }
  const double distance = glm::length(out.ray.origin - ball.center);
  const double world = glm::length(ray.origin) + glm::length(dvec3(inverse[3])) + back * (glm::length(ball.center) + ball.radius);
  out.bound = eps * (48 * (distance + 3 * ball.radius) + 16 * (columns * world + glm::length(dvec3(m[3]))));
  return out;
}

struct Tally {
  std::mutex mutex;
  int rays = 0, crossings = 0, excused = 0, failures = 0;
  void fail(const std::string& what) {
    const std::lock_guard lock(mutex);
    if (++failures <= 5) ADD_FAILURE() << what;
  }
};

void check(const Scene& scene, const FlatScene& flat, const std::map<Name, Placed>& placed,
           const reference::SceneWitness& witness, const RayRecord& record, const RayList& list, Tally& tally) {
  const reference::Ray ray{{record.ox, record.oy, record.oz}, {record.dx, record.dy, record.dz}, 0, HUGE_VAL};
  const std::string where =
      fmt::format("\nray {:a} {:a} {:a}  {:a} {:a} {:a}", record.ox, record.oy, record.oz, record.dx, record.dy, record.dz);
  if (list.overflow) tally.fail("overflow" + where);
  if (list.any != !list.hits.empty() || (list.closest.slot == CAPLET_NONE) != list.hits.empty())
    tally.fail("nearest, any and the list do not agree" + where);
  for (std::size_t i = 1; i < list.hits.size(); ++i)
    if (!(list.hits[i].t >= list.hits[i - 1].t)) tally.fail("the list is not in order" + where);

  std::map<Name, std::pair<std::vector<reference::SceneHit>, std::vector<std::size_t>>> both;
  for (const reference::SceneHit& hit : witness.all(ray)) both[name_of(hit)].first.push_back(hit);
  for (std::size_t i = 0; i < list.hits.size(); ++i) both[name_of(scene, flat, list.hits[i])].second.push_back(i);
  bool excused = false;
  for (const auto& [name, pair] : both) {
    const auto& [expected, found] = pair;
    const auto it = placed.find(name);
    if (it == placed.end()) {
      tally.fail(fmt::format("there is no shape {} {} {}", name[0], name[1], name[2]) + where);
      continue;
    }
    const Local local = local_of(it->second, ray);
    const Shape& shape = *it->second.shape;
    std::string wrong;
    if (expected.size() != found.size()) {
      wrong = "crossings at";
      for (const std::size_t k : found) wrong += fmt::format(" {}", list.hits[k].t);
      wrong += ", the witness says";
      for (const reference::SceneHit& hit : expected) wrong += fmt::format(" {}", hit.t);
      wrong += fmt::format("; margin {} bound {}", reference::margin(it->second.primitive, local.ray), local.bound);
    }
    for (std::size_t k = 0; wrong.empty() && k < found.size(); ++k) {
      const HitRecord& hit = list.hits[found[k]];
      // A mirrored mesh has its winding, and with it what counts as leaving, turned.
      const bool wound =
          std::holds_alternative<TriangleMeshShape>(shape.geometry) || std::holds_alternative<BilinearMeshShape>(shape.geometry);
      if (!wound && expected[k].leaving != is_leaving(hit)) wrong = fmt::format("crossing {} is on the other side", k);
      if (std::abs(local.value(0.5 * (expected[k].t + double(hit.t)))) > 2 * local.bound)
        wrong = fmt::format("crossing at {}, the witness says {}", hit.t, expected[k].t);
      if (expected[k].surface != surface_number(hit) && expected[k].surface_margin > 1e-4)
        wrong = fmt::format("surface {}, the witness says {}", surface_number(hit), expected[k].surface);
      if (expected[k].surface == surface_number(hit) && list.surfaces[found[k]].material != expected[k].material)
        wrong = fmt::format("material {}, the witness says {}", list.surfaces[found[k]].material, expected[k].material);
      // Toward the side that the normal is of: outward, along the plane's or the winding's normal, turned by ReverseOrientation.
      const CrossingSurface& s = list.surfaces[found[k]];
      const dvec3 n(s.ng[0], s.ng[1], s.ng[2]), p(s.p[0], s.p[1], s.p[2]);
      if (wrong.empty() && expected[k].surface_margin > 1e-3 &&
          glm::dot(witness.normal(expected[k], ray.origin + expected[k].t * ray.direction), n) < 0.9)
        wrong = fmt::format("normal {} {} {} at {}", n.x, n.y, n.z, hit.t);
    }
    if (wrong.empty()) continue;
    if (local.excused())
      excused = true;
    else
      tally.fail(fmt::format("instance {} shape {} primitive {}: ", static_cast<int>(name[0]), name[1], name[2]) + wrong + where);
  }
  const std::lock_guard lock(tally.mutex);
  ++tally.rays;
  tally.crossings += static_cast<int>(list.hits.size());
  tally.excused += excused;
}

TEST(Scenes, OfAllShapesAgreeWithTheWitness) {
  Tally tally;
  for (int i = 0; i < 6 * scale_of_test(); ++i) {
    const Scene scene = random_scene(100 + static_cast<std::uint32_t>(i));
    const FlatScene flat = lower(scene);
    const reference::SceneWitness witness(scene);
    const std::map<Name, Placed> placed = placed_of(scene);
    EXPECT_EQ(placed.size(), witness.size());
    const std::vector<RayRecord> rays = random_rays(200 + static_cast<std::uint32_t>(i), 2000);
    const std::vector<RayList> lists = tracer().trace(flat, rays, capacity);
    tbb::parallel_for(std::size_t{0}, rays.size(),
                      [&](std::size_t k) { check(scene, flat, placed, witness, rays[k], lists[k], tally); });
  }
  std::printf("%d rays, %d crossings, %d excused, %d failures\n", tally.rays, tally.crossings, tally.excused, tally.failures);
  EXPECT_EQ(tally.failures, 0);
  EXPECT_GT(tally.crossings, tally.rays);
  EXPECT_LT(tally.excused, tally.rays / 50);
}

// Eight primitives at a time or one: the same crossings of the same primitives. Contraction may differ between the two, so that
// rays that graze may differ in both.
TEST(Scenes, AreTheSameForBothWidths) {
  int rays_compared = 0, different = 0, crossings = 0;
  for (std::uint32_t i = 0; i < 4; ++i) {
    const Scene scene = random_scene(300 + i);
    const FlatScene flat = lower(scene);
    const std::vector<RayRecord> rays = random_rays(400 + i, 2000);
    const std::vector<RayList> wide = tracer(8).trace(flat, rays, capacity), scalar = tracer(1).trace(flat, rays, capacity);
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
  const std::vector<RayList> all = tracer().trace(flat, rays, capacity);
  std::vector<RayRecord> below = rays, at = rays, beyond = rays;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (all[i].hits.empty()) continue;
    const float t = all[i].hits[all[i].hits.size() / 2].t;
    below[i].t_max = t;                          // the crossing itself is not in the open interval
    at[i].t_max = std::nextafter(t, HUGE_VALF);  // just inside
    beyond[i].t_min = t;                         // those behind it
  }
  const auto lists_below = tracer().trace(flat, below, capacity), lists_at = tracer().trace(flat, at, capacity),
             lists_beyond = tracer().trace(flat, beyond, capacity);
  int counted = 0, odd = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (all[i].hits.empty()) continue;
    ++counted;
    const float t = all[i].hits[all[i].hits.size() / 2].t;
    const auto among = [&](const auto& keep) { return std::count_if(all[i].hits.begin(), all[i].hits.end(), keep); };
    EXPECT_EQ(lists_below[i].hits.size(), among([&](const HitRecord& hit) { return hit.t < t; })) << i;
    EXPECT_EQ(lists_at[i].hits.size(), among([&](const HitRecord& hit) { return hit.t <= t; })) << i;
    // Csg shapes take crossings closer together than their bounds as one, and that as behind when it begins there.
    odd += lists_beyond[i].hits.size() != static_cast<std::size_t>(among([&](const HitRecord& hit) { return hit.t > t; }));
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

// Rays go to object space unnormalised: t is one measure for all. Were directions normalised there, a shape stretched along the
// ray by s would have its t divided by s, and all but the first would be out of order.
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
    const dmat4 placed = glm::scale(glm::translate(dmat4(1), dvec3(0, 0, z + gap + half)), dvec3(1, 1, half));
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
    const std::vector<RayRecord> rays = {list_ray({0, 0, -1}, {0, 0, speed})};
    const RayList list = tracer().trace(lower(scene), rays, capacity)[0];
    ASSERT_EQ(list.hits.size(), expected.size());
    EXPECT_EQ(list.closest.t, list.hits[0].t);
    for (std::size_t i = 0; i < expected.size(); ++i) {
      EXPECT_NEAR(double(list.hits[i].t) * speed, expected[i] + 1, 1e-5 * (expected[i] + 1)) << i;
      EXPECT_EQ(is_leaving(list.hits[i]), i % 2 == 1) << i;
    }
    // The nearest one from anywhere along the row.
    for (std::size_t i = 0; i + 1 < expected.size(); ++i) {
      const double start = 0.5 * (expected[i] + expected[i + 1]);
      const std::vector<RayRecord> ray = {list_ray({0, 0, start}, {0, 0, speed})};
      const RayList next = tracer().trace(lower(scene), ray, capacity)[0];
      ASSERT_FALSE(next.hits.empty());
      EXPECT_NEAR(double(next.closest.t) * speed, expected[i + 1] - start, 1e-5 * (expected[i + 1] + 1));
      EXPECT_EQ(next.hits.size(), expected.size() - i - 1);
    }
  }
}

}  // namespace
}  // namespace caplet::test
