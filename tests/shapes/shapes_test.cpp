// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The shape kernels against the reference, which gets the same float bits.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <bit>
#include <cmath>
#include <glm/geometric.hpp>
#include <mutex>

#include "cases.h"
#include "judge.h"
#include "lower/detail/shapes.h"
#include "shared/kinds.h"
#include "support/test_device.h"

namespace caplet::test {
namespace {

using glm::dvec3;

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
                  << fmt::format("\nray: {:a} {:a} {:a}  {:a} {:a} {:a}", r.ox, r.oy, r.oz, r.dx,
                                 r.dy, r.dz);
  }
};

dvec3 f_point(const reference::Ray& ray, double t) { return ray.origin + t * ray.direction; }

// A shape that may be crossed many times: on its way from 0 to `end`, where it is said to leave or
// to enter, the ray must not have been further than `slack` on the other side of the surface. What
// is thinner counts as one event.
void check_way(const auto& f, const std::vector<reference::Crossing>& crossings, double end,
               bool leaving, double slack, const auto& fail) {
  for (std::size_t i = 0; i + 1 < crossings.size(); ++i) {
    const double low = std::max(0.0, crossings[i].t), high = std::min(end, crossings[i + 1].t);
    if (!(low < high) || crossings[i].leaving != leaving) continue;
    // The ray is between two crossings, on the side that it should not have been on.
    constexpr int samples = 64;
    for (int k = 1; k < samples; ++k)
      if (const double there = f(low + (high - low) * k / samples); std::abs(there) > slack) {
        fail(crossings[i].t, there / slack);
        return;
      }
  }
  // Before the first crossing and behind the last all is outside.
  if (leaving && !crossings.empty() && crossings[0].t > 0 &&
      f(0.5 * std::min(end, crossings[0].t)) > slack)
    fail(crossings[0].t, f(0.5 * std::min(end, crossings[0].t)) / slack);
}

void check_ray(const FlatPrimitive& p, const reference::Primitive& reference, const RayRecord& ray,
               const Probed& probed, Tally& tally) {
  const reference::Ray exact = reference_ray(ray);
  const double bound = surface_bound(p, reference, ray);
  const double speed = glm::length(exact.direction);
  const auto f = [&](double t) {
    return reference::value(reference, exact.origin + t * exact.direction);
  };
  const auto expected = reference::closest(reference, exact);
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
    // Within the bound of its plane a triangle is seen edge-on: the kernel then reports a point of
    // the ray beside it.
    if (!(distance <= bound) &&
        !(p.shape == shape_triangle && distance <= extent_of(p, reference).reach &&
          reference::referee(reference, exact, bound) == reference::Verdict::tangent))
      tally.fail(fmt::format("the hit is {} off the surface, allowed {}", distance, bound), p, ray);
  }
  if (hit && surface_count(reference) > 1) {
    const auto number = static_cast<int>(probed.hit.surface & CAPLET_SURFACE_MASK);
    const double off =
        reference::distance_from_surface(reference, f_point(exact, probed.hit.t), number);
    if (!(off <= 2 * bound))
      tally.fail(
          fmt::format("the hit is said to be on surface {}, {} away; bound {}", number, off, bound),
          p, ray);
  }
  if (std::holds_alternative<reference::Csg>(reference)) {
    check_way(f, reference::crossings(reference, exact), hit ? double(probed.hit.t) : HUGE_VAL,
              hit && leaving, 2 * bound, [&](double t, double excess) {
                tally.fail(fmt::format("hit {} at {} leaving {}: before that the ray crosses the "
                                       "surface at {}, and goes {} of what is allowed beyond",
                                       hit, probed.hit.t, leaving, t, excess),
                           p, ray);
              });
    return;
  }
  const bool same = hit == expected.has_value() && (!hit || leaving == expected->leaving);
  if (same && hit) {
    // Between both parameters the ray stays within the bound of the surface: the same crossing.
    const double middle = f(0.5 * (expected->t + probed.hit.t));
    // A patch that is seen edge-on has crossings without number, and of a molecular one the line
    // may pass the border at another crossing.
    if (!(std::abs(middle) <= 2 * bound) &&
        !((p.shape == shape_bilinear || p.shape == shape_molecular_patch) &&
          reference::referee(reference, exact, bound) == reference::Verdict::tangent))
      tally.fail(fmt::format("t = {}, the reference says {} (lengths of {})", probed.hit.t,
                             expected->t, speed),
                 p, ray);
  }
  if (!same) {
    {
      const std::lock_guard lock(tally.mutex);
      tally.disagreements++;
    }
    if (begins_there) return;
    const reference::Verdict verdict = reference::referee(reference, exact, bound);
    if (verdict != reference::Verdict::tangent)
      tally.fail(fmt::format("hit {} leaving {}, the reference says hit {} leaving {}, the referee "
                             "{}; margin {} bound {}",
                             hit, leaving, expected.has_value(), expected && expected->leaving,
                             verdict == reference::Verdict::hit ? "hit" : "miss",
                             reference::margin(reference, exact), bound),
                 p, ray);
  }
}

class ShapeAgainstReference : public testing::TestWithParam<ShapeKind> {};

void compare(const ShapeKind& kind, int width, bool hard, int primitives, int rays,
             std::uint32_t seed) {
  CaseMaker maker(seed);
  const CaseSet cases = maker.set(kind.shape, hard, test_scale() * primitives, rays);
  const Probe probe(test_device(), width, cases.primitives, cases.leaves);
  const std::vector<Probed> probed = probe.trace(cases.which, cases.rays);
  Tally tally;
  tbb::parallel_for(std::size_t{0}, cases.rays.size(), [&](std::size_t i) {
    check_ray(cases.primitive(i), cases.reference(i), cases.rays[i], probed[i], tally);
  });
  std::printf(
      "%zu rays, %d hits, %d leaving, %d disagreements, %d failures, worst %.3f of the bound\n",
      cases.rays.size(), tally.hits, tally.leaving, tally.disagreements, tally.failures,
      tally.worst);
  EXPECT_EQ(tally.failures, 0);
  EXPECT_GT(tally.hits, static_cast<int>(cases.rays.size() / 5));
  if (reference::is_solid(cases.references[0])) {
    EXPECT_GT(tally.leaving, static_cast<int>(cases.rays.size() / 50));
  }
}

// What of a polyhedron lies in `leaves`: centre, offsets (the fourth of each plane) and what else
// the header holds of lengths.
void scale_polyhedron(FlatPrimitive& p, float scale, std::vector<float>& leaves) {
  float* data = &leaves.at(std::bit_cast<std::uint32_t>(p.data[0]));
  const auto count = std::bit_cast<std::uint32_t>(data[3]);
  for (const std::size_t i : {0U, 1U, 2U, 4U}) data[i] *= scale;
  for (std::size_t i = 0; i < count; ++i) data[8 + 4 * i + 3] *= scale;
  for (int i = 0; i < 6; ++i) p.kept_box()[i] *= scale;
}

// The same of molecular patches: centre, radii, and the fourth of each plane.
void scale_patch(FlatPrimitive& p, float scale, std::vector<float>& leaves) {
  float* data = &leaves.at(molecular_patch_begin(p.data));
  const auto count = std::bit_cast<std::uint32_t>(data[4]);
  for (std::size_t i = 0; i < 4; ++i) data[i] *= scale;
  if (count == CAPLET_NONE) data[5] *= scale;
  for (std::size_t i = 0; count != CAPLET_NONE && i < count; ++i) data[8 + 4 * i + 3] *= scale;
  for (int i = 0; i < 6; ++i) p.kept_box()[i] *= scale;
}

TEST_P(ShapeAgainstReference, OrdinaryScales) { compare(GetParam(), 8, false, 1000, 60, 11); }
TEST_P(ShapeAgainstReference, AllScales) { compare(GetParam(), 8, true, 1000, 60, 12); }
TEST_P(ShapeAgainstReference, OneAtATime) { compare(GetParam(), 1, true, 200, 50, 13); }

// Scaling by a power of two scales every intermediate result exactly.
TEST_P(ShapeAgainstReference, ScaledByPowersOfTwo) {
  if (GetParam().shape == shape_csg)
    GTEST_SKIP() << "bounds inside are rounded outward, which does not scale";
  CaseMaker maker(21);
  CaseSet cases = maker.set(GetParam().shape, false, 200, 50);
  const auto first = Probe(test_device(), test_width(), cases.primitives, cases.leaves)
                         .trace(cases.which, cases.rays);
  for (const float scale : {0x1p-7f, 0x1p9f}) {
    CaseSet scaled = cases;
    for (FlatPrimitive& p : scaled.primitives) {
      for (int i = 0; i < length_count(p); ++i)
        if (!(p.shape == shape_disk && i >= 3 && i < 6)) p.data[i] *= scale;
      if (p.shape == shape_polyhedron) scale_polyhedron(p, scale, scaled.leaves);
      if (p.shape == shape_molecular_patch) scale_patch(p, scale, scaled.leaves);
    }
    for (RayRecord& r : scaled.rays) r.ox *= scale, r.oy *= scale, r.oz *= scale;
    const auto second = Probe(test_device(), test_width(), scaled.primitives, scaled.leaves)
                            .trace(scaled.which, scaled.rays);
    for (std::size_t i = 0; i < first.size(); ++i) {
      ASSERT_EQ(first[i].hit.slot == CAPLET_NONE, second[i].hit.slot == CAPLET_NONE)
          << i
          << fmt::format(" ray {} {} {} {} {} {}", cases.rays[i].ox, cases.rays[i].oy,
                         cases.rays[i].oz, cases.rays[i].dx, cases.rays[i].dy, cases.rays[i].dz)
          << " t " << first[i].hit.t << " or " << second[i].hit.t << " scale " << scale
          << " distance "
          << reference::value(cases.reference(i), reference_ray(cases.rays[i]).origin);
      ASSERT_EQ(first[i].hit.surface, second[i].hit.surface) << i;
      if (first[i].hit.slot != CAPLET_NONE) {
        ASSERT_EQ(first[i].hit.t * scale, second[i].hit.t) << i;
      }
    }
  }
}

// Coordinates on a grid of 2^-9, shifted by whole numbers: differences are exact, so hits are the
// same bits.
TEST_P(ShapeAgainstReference, Shifted) {
  CaseMaker maker(22);
  CaseSet cases = maker.set(GetParam().shape, false, 200, 50);
  const int coordinates = coordinate_count(cases.primitives[0]);
  if (coordinates == 0)
    GTEST_SKIP() << "stays around its axis, or around a centre made of its bounds";
  const auto grid = [](float& x) {
    x = std::round(std::clamp(x, -4000.f, 4000.f) * 0x1p9f) * 0x1p-9f;
  };
  for (FlatPrimitive& p : cases.primitives)
    for (int i = 0; i < coordinates; ++i) grid(p.data[i]);
  for (RayRecord& r : cases.rays) grid(r.ox), grid(r.oy), grid(r.oz);
  CaseSet shifted = cases;
  const float shift[3] = {1024, -2048, 512};
  for (FlatPrimitive& p : shifted.primitives)
    for (int i = 0; i < coordinates; ++i) p.data[i] += shift[i % 3];
  for (RayRecord& r : shifted.rays) r.ox += shift[0], r.oy += shift[1], r.oz += shift[2];
  const auto first =
      Probe(test_device(), test_width(), cases.primitives).trace(cases.which, cases.rays);
  const auto second =
      Probe(test_device(), test_width(), shifted.primitives).trace(shifted.which, shifted.rays);
  int hits = 0;
  for (std::size_t i = 0; i < first.size(); ++i) {
    ASSERT_EQ(first[i].hit.surface, second[i].hit.surface) << i;
    ASSERT_EQ(first[i].hit.t, second[i].hit.t) << i;
    hits += first[i].hit.slot != CAPLET_NONE;
  }
  EXPECT_GT(hits, 1000);
}

TEST_P(ShapeAgainstReference, UselessRaysMiss) {
  CaseMaker maker(23);
  const float nan = std::nanf(""), inf = HUGE_VALF;
  const CaseSet cases = maker.set(GetParam().shape, false, 1, 0);
  const Extent extent = extent_of(cases.primitives[0], cases.references[0]);
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
  const auto probed = Probe(test_device(), test_width(), cases.primitives, cases.leaves)
                          .trace(std::vector<std::uint32_t>(rays.size(), 0), rays);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    EXPECT_EQ(probed[i].hit.slot, CAPLET_NONE) << i;
    EXPECT_EQ(probed[i].hit.t, inf) << i;
    EXPECT_FALSE(probed[i].any) << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, ShapeAgainstReference,
                         testing::ValuesIn(shape_kinds().begin(), shape_kinds().end()),
                         [](const auto& instance) { return std::string(instance.param.name); });

TEST(ShapeKinds, EveryShapeIsOnTrial) {
  for (const ShapeKind& kind : shape_kinds()) {
    CaseSet cases;
    CaseMaker(1).add_primitive(kind.shape, true, cases);
    ASSERT_EQ(cases.primitives.size(), 1u) << kind.name;
    EXPECT_EQ(cases.primitives[0].shape, static_cast<unsigned>(kind.shape)) << kind.name;
  }
}

// --- Relations between shapes ---

// Each kernel is within its bound of the same surface.
void expect_same(const CaseSet& a, const CaseSet& b) {
  const auto first =
      Probe(test_device(), test_width(), a.primitives, a.leaves).trace(a.which, a.rays);
  const auto second =
      Probe(test_device(), test_width(), b.primitives, b.leaves).trace(b.which, b.rays);
  int hits = 0;
  for (std::size_t i = 0; i < first.size(); ++i) {
    const FlatPrimitive& p = a.primitives[a.which[i]];
    const reference::Primitive& reference = a.reference(i);
    const reference::Ray exact = reference_ray(a.rays[i]);
    const double bound = surface_bound(p, reference, a.rays[i]) +
                         surface_bound(b.primitive(i), b.reference(i), b.rays[i]);
    const bool hit = first[i].hit.slot != CAPLET_NONE, other = second[i].hit.slot != CAPLET_NONE;
    if (hit != other || first[i].hit.surface != second[i].hit.surface) {
      ASSERT_TRUE(std::abs(reference::value(reference, exact.origin)) <= bound ||
                  reference::referee(reference, exact, bound) == reference::Verdict::tangent)
          << i;
    } else if (hit) {
      // Between both parameters the ray stays near the surface: the same crossing.
      const double middle = 0.5 * (double(first[i].hit.t) + double(second[i].hit.t));
      EXPECT_LE(std::abs(reference::value(reference, exact.origin + middle * exact.direction)),
                bound)
          << i;
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
    swapped.renew_references();
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
  capsules.renew_references();
  tapered.renew_references();
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
  tapered.renew_references();
  expect_same(capsules, tapered);
}

// A cylinder's and a cone's surfaces are named by their ends.
void expect_same_but_named(const CaseSet& a, CaseSet b, const auto& renamed) {
  const auto first =
      Probe(test_device(), test_width(), a.primitives, a.leaves).trace(a.which, a.rays);
  const auto second =
      Probe(test_device(), test_width(), b.primitives, b.leaves).trace(b.which, b.rays);
  int hits = 0, odd = 0, wrong = 0, misnamed = 0;
  for (std::size_t i = 0; i < first.size(); ++i) {
    const reference::Ray exact = reference_ray(a.rays[i]);
    const double bound = surface_bound(a.primitive(i), a.reference(i), a.rays[i]);
    const bool hit = first[i].hit.slot != CAPLET_NONE, other = second[i].hit.slot != CAPLET_NONE;
    const auto at = [&](const Probed& probed) {
      return exact.origin + double(probed.hit.t) * exact.direction;
    };
    if (!hit || !other || (first[i].hit.surface ^ second[i].hit.surface) > CAPLET_SURFACE_MASK) {
      if (hit == other && !hit) continue;
      ++odd;
      const bool may_be =
          std::abs(reference::value(a.reference(i), exact.origin)) <= bound ||
          reference::referee(a.reference(i), exact, bound) == reference::Verdict::tangent;
      if (!may_be && ++wrong <= 5)
        ADD_FAILURE() << "ray " << i << ": hit " << hit << " and " << other << ": "
                      << described(a.primitive(i), a.rays[i]);
      continue;
    }
    ++hits;
    // Between both parameters the ray stays near the surface: the same crossing.
    if (std::abs(reference::value(a.reference(i), 0.5 * (at(first[i]) + at(second[i])))) >
            2 * bound &&
        ++wrong <= 5)
      ADD_FAILURE() << "ray " << i << ": t " << first[i].hit.t << " and " << second[i].hit.t;
    // Both names have to do, each for the other's point.
    const auto number = static_cast<int>(first[i].hit.surface & CAPLET_SURFACE_MASK);
    const auto other_number = static_cast<int>(second[i].hit.surface & CAPLET_SURFACE_MASK);
    if (other_number == renamed(number)) continue;
    const double off =
        reference::distance_from_surface(b.reference(i), at(first[i]), renamed(number));
    const double other_off =
        reference::distance_from_surface(b.reference(i), at(second[i]), other_number);
    if (std::max(off, other_off) > 2 * bound && ++misnamed <= 5)
      ADD_FAILURE() << "ray " << i << ": surfaces " << number << " and " << other_number;
  }
  EXPECT_EQ(wrong, 0);
  EXPECT_EQ(misnamed, 0);
  EXPECT_GT(hits, 1000);
  EXPECT_LT(odd, static_cast<int>(first.size() / 10));
}

TEST(ShapeRelations, EndsOfCylindersAndConesAreInterchangeable) {
  CaseMaker maker(35);
  for (const int shape : {shape_cylinder, shape_cone}) {
    const CaseSet cases = maker.set(shape, true, 200, 50);
    CaseSet swapped = cases;
    for (FlatPrimitive& p : swapped.primitives) {
      std::swap_ranges(p.data, p.data + 3, p.data + 3);
      if (shape == shape_cone) std::swap(p.data[6], p.data[7]);
      std::swap(p.data[shape == shape_cone ? 8 : 7], p.data[shape == shape_cone ? 9 : 8]);
    }
    swapped.renew_references();
    expect_same_but_named(cases, swapped, [](int n) { return n == 0 ? 0 : 3 - n; });
  }
}

TEST(ShapeRelations, ConesOfEqualRadiiAreCylinders) {
  CaseMaker maker(36);
  const CaseSet cylinders = maker.set(shape_cylinder, true, 200, 50);
  CaseSet cones = cylinders;
  for (FlatPrimitive& p : cones.primitives) {
    p.shape = shape_cone;
    p.data[9] = p.data[8];
    p.data[8] = p.data[7];
    p.data[7] = p.data[6];
  }
  cones.renew_references();
  expect_same_but_named(cylinders, cones, [](int n) { return n; });
}

TEST(ShapeRelations, RoundCylindersAreCapsules) {
  CaseMaker maker(37);
  const CaseSet capsules = maker.set(shape_capsule, true, 200, 50),
                tapered = maker.set(shape_tapered_capsule, true, 200, 50);
  CaseSet cylinders = capsules, cones = tapered;
  // Far from the origin a short axis may vanish, and validation refuses cylinders and cones without
  // one.
  const auto has_axis = [](const FlatPrimitive& p) {
    return !std::equal(p.data, p.data + 3, p.data + 3);
  };
  for (FlatPrimitive& p : cylinders.primitives) {
    if (!has_axis(p)) continue;
    p.shape = shape_cylinder;
    p.data[7] = p.data[8] = CAPLET_CAP_ROUND;
  }
  for (FlatPrimitive& p : cones.primitives) {
    if (!has_axis(p)) continue;
    p.shape = shape_cone;
    p.data[8] = p.data[9] = CAPLET_CAP_ROUND;
  }
  cylinders.renew_references();
  cones.renew_references();
  expect_same_but_named(cylinders, capsules, [](int) { return 0; });
  expect_same_but_named(cones, tapered, [](int) { return 0; });
}

TEST(ShapeRelations, ABoxIsThePolyhedronOfItsSixPlanes) {
  CaseMaker maker(38);
  const CaseSet boxes = maker.set(shape_box, true, 200, 50);
  CaseSet polyhedra = boxes;
  for (FlatPrimitive& p : polyhedra.primitives) {
    PolyhedronShape six;
    for (int k = 0; k < 3; ++k)
      for (const int high : {0, 1}) {
        dvec3 n(0);
        n[k] = high != 0 ? 1 : -1;
        six.normals.push_back(n);
        six.points.push_back(dvec3(p.data[3 * high], p.data[3 * high + 1], p.data[3 * high + 2]));
      }
    p = flat_primitive(six, glm::dmat4(1), polyhedra.leaves);
  }
  polyhedra.renew_references();
  expect_same_but_named(boxes, polyhedra, [](int n) { return n; });
}

TEST(ShapeRelations, PartsThatAreAllAreTheWhole) {
  CaseMaker maker(39);
  CaseSet spheres = maker.set(shape_sphere, true, 200, 0);
  CaseSet parts;
  for (FlatPrimitive& p : spheres.primitives) {
    p.data[0] = p.data[1] = p.data[2] = 0;
    parts.primitives.push_back(make_partial_sphere(p.data[3], -p.data[3], p.data[3], 7));
  }
  spheres.renew_references();
  for (std::uint32_t i = 0; i < 200; ++i)
    for (int j = 0; j < 50; ++j) {
      spheres.which.push_back(i);
      spheres.rays.push_back(maker.ray(spheres.primitives[i], spheres.references[i]));
    }
  parts.references.resize(200);
  parts.renew_references();
  parts.which = spheres.which;
  parts.rays = spheres.rays;
  expect_same_but_named(spheres, parts, [](int) { return 0; });

  CaseSet disks = maker.set(shape_disk, true, 200, 0), rings;
  for (FlatPrimitive& p : disks.primitives) {
    p = make_disk({0, 0, p.data[2]}, {0, 0, 1}, p.data[6]);
    rings.primitives.push_back(make_partial_disk(p.data[2], p.data[6], 0, 7));
  }
  disks.renew_references();
  for (std::uint32_t i = 0; i < 200; ++i)
    for (int j = 0; j < 50; ++j) {
      disks.which.push_back(i);
      disks.rays.push_back(maker.ray(disks.primitives[i], disks.references[i]));
    }
  rings.references.resize(200);
  rings.renew_references();
  rings.which = disks.which;
  rings.rays = disks.rays;
  expect_same_but_named(disks, rings, [](int) { return 0; });
}

// Nothing to see, but nothing breaks: no NaN, and any agrees with closest.
TEST(ShapeRelations, ShapesWithoutRadius) {
  CaseMaker maker(34);
  for (const ShapeKind& kind : shape_kinds()) {
    SCOPED_TRACE(kind.name);
    CaseSet cases = maker.set(kind.shape, false, 50, 50);
    for (FlatPrimitive& p : cases.primitives) {
      if (p.shape == shape_sphere) p.data[3] = 0;
      if (p.shape == shape_capsule || p.shape == shape_disk) p.data[6] = 0;
      if (p.shape == shape_tapered_capsule) p.data[6] = p.data[7] = 0;
      if (p.shape == shape_triangle) std::copy(p.data, p.data + 3, p.data + 6);
      if (p.shape == shape_cylinder || p.shape == shape_cone) p.data[6] = 0;
      if (p.shape == shape_cone) p.data[7] = 0;
      if (p.shape == shape_box) p.data[3] = p.data[0];
      if (p.shape == shape_partial_sphere || p.shape == shape_open_cylinder) p.data[0] = 0;
      if (p.shape == shape_partial_disk) p.data[1] = p.data[2] = 0;
      if (p.shape == shape_bilinear) std::copy(p.data, p.data + 6, p.data + 6);
    }
    const auto probed = Probe(test_device(), test_width(), cases.primitives, cases.leaves)
                            .trace(cases.which, cases.rays);
    for (std::size_t i = 0; i < probed.size(); ++i) {
      ASSERT_EQ(probed[i].any, probed[i].hit.slot != CAPLET_NONE);
      ASSERT_FALSE(std::isnan(probed[i].hit.t));
      if (probed[i].hit.slot == CAPLET_NONE) continue;
      const SurfaceOut& s = probed[i].surface;
      for (int k = 0; k < 3; ++k)
        ASSERT_TRUE(std::isfinite(s.p[k]) && std::isfinite(s.ng[k]) && std::isfinite(s.dpdu[k]));
      ASSERT_TRUE(std::isfinite(s.error) && std::isfinite(s.u) && std::isfinite(s.v));
    }
  }
}

}  // namespace
}  // namespace caplet::test
