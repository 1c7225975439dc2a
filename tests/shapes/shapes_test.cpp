// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The shape kernels against the witness, which gets the same float bits.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <mutex>

#include "cases.h"
#include "shared/kinds.h"

namespace caplet::test {
namespace {

using glm::dvec3;

constexpr double eps = 0x1p-24;

const Device& device() {
  static const Device chosen = Device::choose("");
  return chosen;
}

// Bound on the distance of o + t d from the surface, as the kernels' files derive it: a multiple of eps (|o - c| + size). The
// final rounding of t moves the point by eps |t d| <= eps (|o - c| + size) more.
double surface_bound(const FlatPrimitive& p, const RayRecord& ray) {
  const Extent extent = extent_of(p);
  const double distance = glm::length(dvec3(ray.ox, ray.oy, ray.oz) - extent.center);
  const double factor = p.shape == shape_capsule ? 12 : p.shape == shape_tapered_capsule ? 16 : 8;
  return (factor + 1) * eps * (distance + extent.radius + extent.reach);
}

struct Tally {
  std::mutex mutex;
  int hits = 0, leaving = 0, disagreements = 0, failures = 0;
  double worst = 0;
  void fail(const std::string& what, const FlatPrimitive& p, const RayRecord& r) {
    const std::lock_guard lock(mutex);
    if (++failures > 5) return;
    std::string data;
    for (const float x : p.data) data += fmt::format("{:a} ", x);
    ADD_FAILURE() << what << "\nshape " << p.shape << ": " << data
                  << fmt::format("\nray: {:a} {:a} {:a}  {:a} {:a} {:a}", r.ox, r.oy, r.oz, r.dx, r.dy, r.dz);
  }
};

void check_ray(const FlatPrimitive& p, const RayRecord& ray, const Probed& probed, Tally& tally) {
  const reference::Primitive witness = witness_of(p);
  const reference::Ray exact = witness_ray(ray);
  const double bound = surface_bound(p, ray);
  const double speed = glm::length(exact.direction);
  const auto f = [&](double t) { return reference::value(witness, exact.origin + t * exact.direction); };
  const auto expected = reference::closest(witness, exact);
  const bool hit = probed.hit.slot != CAPLET_NONE;
  if (probed.any != hit) tally.fail("any hit is not the existence of a closest one", p, ray);
  // Where the ray begins at the surface, which side it begins on is rounding.
  const bool begins_there = std::abs(f(0)) <= bound;
  const bool leaving = (probed.hit.surface >> 16 & 1u) != 0;

  if (hit) {
    const double t = probed.hit.t;
    const double distance = std::abs(f(t));
    {
      const std::lock_guard lock(tally.mutex);
      tally.hits++;
      tally.leaving += leaving;
      tally.worst = std::max(tally.worst, distance / bound);
    }
    if (!(t > 0)) tally.fail(fmt::format("t = {}", t), p, ray);
    // Within the bound of its plane a triangle is seen edge-on: the kernel then reports a point of the ray beside it.
    if (!(distance <= bound) && !(p.shape == shape_triangle && distance <= extent_of(p).reach &&
                                  reference::referee(witness, exact, bound) == reference::Verdict::tangent))
      tally.fail(fmt::format("the hit is {} off the surface, allowed {}", distance, bound), p, ray);
  }
  const bool same = hit == expected.has_value() && (!hit || leaving == expected->leaving);
  if (same && hit) {
    // Between both parameters the ray stays within the bound of the surface: the same crossing.
    const double middle = f(0.5 * (expected->t + probed.hit.t));
    if (!(std::abs(middle) <= 2 * bound))
      tally.fail(fmt::format("t = {}, the witness says {} (lengths of {})", probed.hit.t, expected->t, speed), p, ray);
  }
  if (!same) {
    {
      const std::lock_guard lock(tally.mutex);
      tally.disagreements++;
    }
    if (begins_there) return;
    const reference::Verdict verdict = reference::referee(witness, exact, bound);
    if (verdict != reference::Verdict::tangent)
      tally.fail(fmt::format("hit {} leaving {}, the witness says hit {} leaving {}, the referee {}; margin {} bound {}", hit,
                             leaving, expected.has_value(), expected && expected->leaving,
                             verdict == reference::Verdict::hit ? "hit" : "miss", reference::margin(witness, exact), bound),
                 p, ray);
  }
}

struct ShapeKind {
  int shape;
  const char* name;
};
void PrintTo(const ShapeKind& kind, std::ostream* out) { *out << kind.name; }

class ShapeAgainstWitness : public testing::TestWithParam<ShapeKind> {};

void compare(const ShapeKind& kind, int width, bool hard, int primitives, int rays, std::uint32_t seed) {
  CaseMaker maker(seed);
  const CaseSet cases = maker.set(kind.shape, hard, test_scale() * primitives, rays);
  const Probe probe(device(), width, cases.primitives);
  const std::vector<Probed> probed = probe.trace(cases.which, cases.rays);
  Tally tally;
  tbb::parallel_for(std::size_t{0}, cases.rays.size(),
                    [&](std::size_t i) { check_ray(cases.primitives[cases.which[i]], cases.rays[i], probed[i], tally); });
  std::printf("%zu rays, %d hits, %d leaving, %d disagreements, %d failures, worst %.3f of the bound\n", cases.rays.size(),
              tally.hits, tally.leaving, tally.disagreements, tally.failures, tally.worst);
  EXPECT_EQ(tally.failures, 0);
  EXPECT_GT(tally.hits, static_cast<int>(cases.rays.size() / 5));
  if (kind.shape <= shape_tapered_capsule) {
    EXPECT_GT(tally.leaving, static_cast<int>(cases.rays.size() / 50));
  }
}

TEST_P(ShapeAgainstWitness, OrdinaryScales) { compare(GetParam(), 8, false, 1000, 60, 11); }
TEST_P(ShapeAgainstWitness, AllScales) { compare(GetParam(), 8, true, 1000, 60, 12); }
TEST_P(ShapeAgainstWitness, OneAtATime) { compare(GetParam(), 1, true, 200, 50, 13); }

// Scaling by a power of two scales every intermediate result exactly.
TEST_P(ShapeAgainstWitness, ScaledByPowersOfTwo) {
  CaseMaker maker(21);
  CaseSet cases = maker.set(GetParam().shape, false, 200, 50);
  const auto first = Probe(device(), 8, cases.primitives).trace(cases.which, cases.rays);
  for (const float scale : {0x1p-7f, 0x1p9f}) {
    CaseSet scaled = cases;
    for (FlatPrimitive& p : scaled.primitives)
      for (int i = 0; i < 9; ++i)
        if (!(p.shape == shape_disk && i >= 3 && i < 6)) p.data[i] *= scale;
    for (RayRecord& r : scaled.rays) r.ox *= scale, r.oy *= scale, r.oz *= scale;
    const auto second = Probe(device(), 8, scaled.primitives).trace(scaled.which, scaled.rays);
    for (std::size_t i = 0; i < first.size(); ++i) {
      ASSERT_EQ(first[i].hit.slot == CAPLET_NONE, second[i].hit.slot == CAPLET_NONE) << i;
      ASSERT_EQ(first[i].hit.surface, second[i].hit.surface) << i;
      if (first[i].hit.slot != CAPLET_NONE) {
        ASSERT_EQ(first[i].hit.t * scale, second[i].hit.t) << i;
      }
    }
  }
}

// Coordinates on a grid of 2^-9, shifted by whole numbers: differences are exact, so hits are the same bits.
TEST_P(ShapeAgainstWitness, Shifted) {
  CaseMaker maker(22);
  CaseSet cases = maker.set(GetParam().shape, false, 200, 50);
  const auto grid = [](float& x) { x = std::round(std::clamp(x, -4000.f, 4000.f) * 0x1p9f) * 0x1p-9f; };
  const auto points = [](const FlatPrimitive& p) {
    return p.shape == shape_sphere || p.shape == shape_disk ? 1 : p.shape == shape_triangle ? 3 : 2;
  };
  for (FlatPrimitive& p : cases.primitives)
    for (int i = 0; i < 3 * points(p); ++i) grid(p.data[i]);
  for (RayRecord& r : cases.rays) grid(r.ox), grid(r.oy), grid(r.oz);
  CaseSet shifted = cases;
  const float shift[3] = {1024, -2048, 512};
  for (FlatPrimitive& p : shifted.primitives)
    for (int i = 0; i < 3 * points(p); ++i) p.data[i] += shift[i % 3];
  for (RayRecord& r : shifted.rays) r.ox += shift[0], r.oy += shift[1], r.oz += shift[2];
  const auto first = Probe(device(), 8, cases.primitives).trace(cases.which, cases.rays);
  const auto second = Probe(device(), 8, shifted.primitives).trace(shifted.which, shifted.rays);
  int hits = 0;
  for (std::size_t i = 0; i < first.size(); ++i) {
    ASSERT_EQ(first[i].hit.surface, second[i].hit.surface) << i;
    ASSERT_EQ(first[i].hit.t, second[i].hit.t) << i;
    hits += first[i].hit.slot != CAPLET_NONE;
  }
  EXPECT_GT(hits, 1000);
}

TEST_P(ShapeAgainstWitness, UselessRaysMiss) {
  CaseMaker maker(23);
  const float nan = std::nanf(""), inf = HUGE_VALF;
  const std::vector<FlatPrimitive> primitives = {maker.primitive(GetParam().shape, false)};
  const Extent extent = extent_of(primitives[0]);
  std::vector<RayRecord> rays;
  for (const float bad : {nan, inf, -inf})
    for (int i = 0; i < 6; ++i) {
      RayRecord r = make_ray(extent.center + dvec3(0, 0, 3 * extent.radius), dvec3(0, 0, -1));
      (i == 0 ? r.ox : i == 1 ? r.oy : i == 2 ? r.oz : i == 3 ? r.dx : i == 4 ? r.dy : r.dz) = bad;
      rays.push_back(r);
    }
  rays.push_back(make_ray(extent.center, dvec3(0)));
  RayRecord backwards = make_ray(extent.center + dvec3(0, 0, 3 * extent.radius), dvec3(0, 0, -1));
  backwards.t_min = 1e30f;
  backwards.t_max = 0;
  rays.push_back(backwards);
  backwards.t_min = 0;
  backwards.t_max = nan;
  const auto probed = Probe(device(), 8, primitives).trace(std::vector<std::uint32_t>(rays.size(), 0), rays);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    EXPECT_EQ(probed[i].hit.slot, CAPLET_NONE) << i;
    EXPECT_EQ(probed[i].hit.t, inf) << i;
    EXPECT_FALSE(probed[i].any) << i;
  }
}

const ShapeKind kinds[] = {{shape_sphere, "sphere"},
                           {shape_capsule, "capsule"},
                           {shape_tapered_capsule, "tapered_capsule"},
                           {shape_triangle, "triangle"},
                           {shape_disk, "disk"}};
INSTANTIATE_TEST_SUITE_P(Kinds, ShapeAgainstWitness, testing::ValuesIn(kinds),
                         [](const auto& instance) { return std::string(instance.param.name); });

TEST(ShapeKinds, EveryShapeIsOnTrial) { EXPECT_EQ(std::size(kinds) + 1, static_cast<std::size_t>(shape_count)); }

// --- Relations between shapes ---

// Each kernel is within its bound of the same surface.
void expect_same(const CaseSet& a, const CaseSet& b) {
  const auto first = Probe(device(), 8, a.primitives).trace(a.which, a.rays);
  const auto second = Probe(device(), 8, b.primitives).trace(b.which, b.rays);
  int hits = 0;
  for (std::size_t i = 0; i < first.size(); ++i) {
    const FlatPrimitive& p = a.primitives[a.which[i]];
    const reference::Primitive witness = witness_of(p);
    const reference::Ray exact = witness_ray(a.rays[i]);
    const double bound = surface_bound(p, a.rays[i]) + surface_bound(b.primitives[b.which[i]], b.rays[i]);
    const bool hit = first[i].hit.slot != CAPLET_NONE, other = second[i].hit.slot != CAPLET_NONE;
    if (hit != other || first[i].hit.surface != second[i].hit.surface) {
      ASSERT_TRUE(std::abs(reference::value(witness, exact.origin)) <= bound ||
                  reference::referee(witness, exact, bound) == reference::Verdict::tangent)
          << i;
    } else if (hit) {
      // Between both parameters the ray stays near the surface: the same crossing.
      const double middle = 0.5 * (double(first[i].hit.t) + double(second[i].hit.t));
      EXPECT_LE(std::abs(reference::value(witness, exact.origin + middle * exact.direction)), bound) << i;
      ++hits;
    }
  }
  EXPECT_GT(hits, 1000);
}

TEST(ShapeRelations, EndsOfACapsuleAreInterchangeable) {
  CaseMaker maker(31);
  for (const int shape : {shape_capsule, shape_tapered_capsule}) {
    const CaseSet cases = maker.set(shape, true, 200, 50);
    CaseSet swapped = cases;
    for (FlatPrimitive& p : swapped.primitives) {
      std::swap_ranges(p.data, p.data + 3, p.data + 3);
      if (p.shape == shape_tapered_capsule) std::swap(p.data[6], p.data[7]);
    }
    expect_same(cases, swapped);
  }
}

TEST(ShapeRelations, EqualEndsMakeASphere) {
  CaseMaker maker(32);
  const CaseSet spheres = maker.set(shape_sphere, true, 200, 50);
  CaseSet capsules = spheres, tapered = spheres;
  for (std::size_t i = 0; i < spheres.primitives.size(); ++i) {
    const float* d = spheres.primitives[i].data;
    capsules.primitives[i] = make_capsule({d[0], d[1], d[2]}, {d[0], d[1], d[2]}, d[3]);
    tapered.primitives[i] = make_tapered({d[0], d[1], d[2]}, {d[0], d[1], d[2]}, d[3], 0.5f * d[3]);
  }
  expect_same(spheres, capsules);
  expect_same(spheres, tapered);
}

TEST(ShapeRelations, EqualRadiiMakeACapsule) {
  CaseMaker maker(33);
  const CaseSet capsules = maker.set(shape_capsule, true, 200, 50);
  CaseSet tapered = capsules;
  for (FlatPrimitive& p : tapered.primitives) {
    p.shape = shape_tapered_capsule;
    p.data[7] = p.data[6];
  }
  expect_same(capsules, tapered);
}

// Nothing to see, but nothing breaks: no NaN, and any agrees with closest.
TEST(ShapeRelations, ShapesWithoutRadius) {
  CaseMaker maker(34);
  for (const ShapeKind& kind : kinds) {
    CaseSet cases = maker.set(kind.shape, false, 50, 50);
    for (FlatPrimitive& p : cases.primitives) {
      if (p.shape == shape_sphere) p.data[3] = 0;
      if (p.shape == shape_capsule || p.shape == shape_disk) p.data[6] = 0;
      if (p.shape == shape_tapered_capsule) p.data[6] = p.data[7] = 0;
      if (p.shape == shape_triangle) std::copy(p.data, p.data + 3, p.data + 6);
    }
    const auto probed = Probe(device(), 8, cases.primitives).trace(cases.which, cases.rays);
    for (std::size_t i = 0; i < probed.size(); ++i) {
      ASSERT_EQ(probed[i].any, probed[i].hit.slot != CAPLET_NONE);
      ASSERT_FALSE(std::isnan(probed[i].hit.t));
      if (probed[i].hit.slot == CAPLET_NONE) continue;
      const SurfaceOut& s = probed[i].surface;
      for (int k = 0; k < 3; ++k) ASSERT_TRUE(std::isfinite(s.p[k]) && std::isfinite(s.ng[k]) && std::isfinite(s.dpdu[k]));
      ASSERT_TRUE(std::isfinite(s.error) && std::isfinite(s.u) && std::isfinite(s.v));
    }
  }
}

}  // namespace
}  // namespace caplet::test
