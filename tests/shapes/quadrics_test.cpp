// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Cylinders and cones: rims that no ray slips through, wherever the model is; ends that may be
// swapped; and shapes that are one another.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <glm/geometric.hpp>

#include "cases.h"
#include "floats.h"
#include "shared/kinds.h"
#include "support/test_device.h"

namespace caplet::test::quadrics_test {
namespace {

using glm::dvec3;
using reference::Frustum;

constexpr float flat = CAPLET_CAP_FLAT, rounded = CAPLET_CAP_ROUND, open = CAPLET_CAP_OPEN;

bool is_hit(const Probed& probed) { return probed.hit.slot != CAPLET_NONE; }
std::uint32_t surface_number(const Probed& probed) {
  return probed.hit.surface & CAPLET_SURFACE_MASK;
}
bool leaves(const Probed& probed) { return (probed.hit.surface & CAPLET_LEAVING) != 0; }

// A cylinder or cone, with what its row holds.
struct Ends {
  dvec3 p0, p1;
  double r0, r1;
  float cap0, cap1;
};
Ends ends_of(const FlatPrimitive& p) {
  const float* d = p.data;
  return p.shape == shape_cylinder ? Ends{point(d), point(d + 3), d[6], d[6], d[7], d[8]}
                                   : Ends{point(d), point(d + 3), d[6], d[7], d[8], d[9]};
}

FlatPrimitive quadric(int shape, const Ends& e) {
  FlatPrimitive p{};
  p.shape = static_cast<std::uint32_t>(shape);
  for (int k = 0; k < 3; ++k) {
    p.data[k] = static_cast<float>(e.p0[k]);
    p.data[3 + k] = static_cast<float>(e.p1[k]);
  }
  int at = 6;
  p.data[at++] = static_cast<float>(e.r0);
  if (shape == shape_cone) p.data[at++] = static_cast<float>(e.r1);
  p.data[at++] = e.cap0;
  p.data[at] = e.cap1;
  return p;
}

reference::Primitive frustum_of(const FlatPrimitive& p) {
  const Ends e = ends_of(p);
  return reference::make_frustum(e.p0, e.p1, {e.r0, e.cap0 == rounded, e.cap0 == open},
                                 {e.r1, e.cap1 == rounded, e.cap1 == open});
}

// docs/numerics.md, "Traversal", and one rounding of t.
double bound_of(const FlatPrimitive& p, const RayRecord& ray) {
  const Ends e = ends_of(p);
  const double size = glm::length(e.p1 - e.p0) + e.r0 + e.r1;
  return 17 * eps * (glm::length(dvec3(ray.ox, ray.oy, ray.oz) - e.p0) + size);
}

// Random ends around a place: lengths from a hundredth to a hundred radii, axes of all directions
// and along x, y, z; for cones apexes, equal radii, and either end the wider one.
FlatPrimitive random_quadric(CaseMaker& maker, int shape, const dvec3& place, bool may_be_open) {
  const double r = std::pow(10.0, maker.uniform(-1, 1)),
               length = r * std::pow(10.0, maker.uniform(-2, 2));
  dvec3 axis = maker.direction();
  const double along = maker.uniform(0, 6);
  if (along < 3) axis = dvec3(along < 1, along >= 1 && along < 2, along >= 2);
  const double other = maker.uniform(0, 1);
  const double r1 = shape == shape_cylinder || other > 0.9 ? r
                    : other < 0.15                         ? 0
                                                           : r * maker.uniform(0, 1);
  const bool turned = maker.uniform(0, 1) < 0.5;
  const auto cap = [&] {
    const double choice = maker.uniform(0, may_be_open ? 3 : 2);
    return choice < 1 ? flat : choice < 2 ? rounded : open;
  };
  const float cap0 = cap(), cap1 = cap();
  return quadric(shape, {place - 0.5 * length * axis, place + 0.5 * length * axis, turned ? r1 : r,
                         turned ? r : r1, cap0, cap1});
}

dvec3 rim_point(CaseMaker& maker, const Ends& e, int end) {
  const dvec3 axis = glm::normalize(e.p1 - e.p0), any = maker.direction();
  const dvec3 across = glm::normalize(any - glm::dot(any, axis) * axis);
  return (end == 0 ? e.p0 : e.p1) + (end == 0 ? e.r0 : e.r1) * across;
}

// A ray from any side past (or through) one of the rims, nearer to it the more often.
RayRecord rim_ray(CaseMaker& maker, const FlatPrimitive& p) {
  const Ends e = ends_of(p);
  const double size = glm::length(e.p1 - e.p0) + e.r0 + e.r1;
  const dvec3 rim = rim_point(maker, e, maker.uniform(0, 1) < 0.5 ? 0 : 1);
  const dvec3 aim = rim + size * std::pow(10.0, maker.uniform(-9, -1)) * maker.direction();
  const dvec3 origin = aim + size * std::pow(10.0, maker.uniform(0, 2)) * maker.direction();
  return make_ray(origin, (aim - origin) * std::pow(10.0, maker.uniform(-2, 2)));
}

struct Cases {
  std::vector<FlatPrimitive> primitives;
  std::vector<std::uint32_t> which;
  std::vector<RayRecord> rays;
};
Cases random_cases(CaseMaker& maker, int shape, int primitives, int rays, double away,
                   bool may_be_open) {
  Cases out;
  while (static_cast<int>(out.primitives.size()) < primitives) {
    const FlatPrimitive p = random_quadric(maker, shape, away * maker.direction(), may_be_open);
    const Ends e = ends_of(p);
    if (e.p0 == e.p1) continue;  // far away short axes round to nothing
    for (int j = 0; j < rays; ++j) {
      out.which.push_back(static_cast<std::uint32_t>(out.primitives.size()));
      out.rays.push_back(rim_ray(maker, p));
    }
    out.primitives.push_back(p);
  }
  return out;
}

std::string text_of(const FlatPrimitive& p, const RayRecord& r) {
  std::string data;
  for (const float x : p.data) data += fmt::format("{:a} ", x);
  return fmt::format("shape {}: {}\nray {:a} {:a} {:a}  {:a} {:a} {:a}", p.shape, data, r.ox, r.oy,
                     r.oz, r.dx, r.dy, r.dz);
}

// --- Rims ---

struct RimCase {
  int shape, width;
  double away;
};
void PrintTo(const RimCase& c, std::ostream* out) {
  *out << fmt::format("{} {} {}", c.shape, c.width, c.away);
}
class QuadricRims : public testing::TestWithParam<RimCase> {};

// Closed solids: what the line enters deeper than the bound is hit, and every hit is a point of the
// surface. Returns how many such rays there are.
int expect_watertight(const Cases& cases, int width) {
  const auto probed = Probe(test_device(), width, cases.primitives).trace(cases.which, cases.rays);
  std::atomic<int> hits = 0, deep = 0, slipped = 0, off = 0;
  tbb::parallel_for(std::size_t{0}, probed.size(), [&](std::size_t i) {
    const FlatPrimitive& p = cases.primitives[cases.which[i]];
    const reference::Primitive reference = frustum_of(p);
    const reference::Ray ray = reference_ray(cases.rays[i]);
    const double bound = bound_of(p, cases.rays[i]);
    const double depth = reference::margin(reference, ray);
    const auto expected = reference::closest(reference, ray);
    if (depth > bound && expected && expected->t * glm::length(ray.direction) > bound) {
      ++deep;
      if (!is_hit(probed[i]) && slipped++ < 3)
        ADD_FAILURE() << "depth " << depth << " > " << bound << "\n" << text_of(p, cases.rays[i]);
    }
    if (!is_hit(probed[i])) return;
    ++hits;
    const double distance =
        std::abs(reference::value(reference, ray.origin + double(probed[i].hit.t) * ray.direction));
    if (distance > bound && off++ < 3)
      ADD_FAILURE() << distance << " off, > " << bound << "\n" << text_of(p, cases.rays[i]);
  });
  std::printf("%zu rays, %d hits, %d deeper than the bound, %d slipped through\n", probed.size(),
              hits.load(), deep.load(), slipped.load());
  EXPECT_EQ(slipped, 0);
  EXPECT_EQ(off, 0);
  return deep;
}

TEST_P(QuadricRims, AreWatertight) {
  const auto [shape, width, away] = GetParam();
  CaseMaker maker(61);
  const Cases cases = random_cases(maker, shape, 100 * test_scale(), 100, away, false);
  EXPECT_GT(expect_watertight(cases, width), static_cast<int>(cases.rays.size() / 4));
}

// Short cones: side and base meet at a sharp angle, and what lies within rounding of both is far
// from either.
TEST(QuadricShapes, SharpRimsEndWhereTheyAre) {
  CaseMaker maker(66);
  Cases cases;
  for (std::uint32_t i = 0; i < 300; ++i) {
    const double length = std::pow(10.0, maker.uniform(-3, -1.5));
    const bool turned = maker.uniform(0, 1) < 0.5;
    const double thin = maker.uniform(0, 0.5);
    const FlatPrimitive p = quadric(shape_cone, {maker.direction(), maker.direction(),
                                                 turned ? thin : 1, turned ? 1 : thin, flat, flat});
    Ends e = ends_of(p);
    e.p1 = e.p0 + length * glm::normalize(e.p1 - e.p0);
    cases.primitives.push_back(quadric(shape_cone, e));
    for (int j = 0; j < 200; ++j) {
      // Nearly within the side.
      const dvec3 rim = rim_point(maker, e, turned ? 1 : 0), apex = turned ? e.p0 : e.p1;
      const dvec3 aim = rim + std::pow(10.0, maker.uniform(-7, -3)) * maker.direction();
      const dvec3 d = glm::normalize(apex - aim) + maker.uniform(0, 2) * maker.direction();
      cases.which.push_back(i);
      cases.rays.push_back(make_ray(aim - maker.uniform(0.5, 2) * d, d));
    }
  }
  EXPECT_GT(expect_watertight(cases, 8), 3000);
}

// The direction is the axis to rounding, or exactly: the distance from the axis decides, and
// nothing else has digits.
TEST(QuadricShapes, RaysAlongTheAxis) {
  CaseMaker maker(67);
  for (const int shape : {shape_cylinder, shape_cone}) {
    Cases cases;
    while (cases.primitives.size() < 1000) {
      const FlatPrimitive p = random_quadric(maker, shape, 10.0 * maker.direction(), false);
      const Ends e = ends_of(p);
      const dvec3 axis = e.p1 - e.p0;
      for (int j = 0; j < 20; ++j) {
        const dvec3 rim = rim_point(maker, e, j % 2), center = j % 2 == 0 ? e.p0 : e.p1;
        const double off =
            std::pow(10.0, maker.uniform(-6, 0)) * (maker.uniform(0, 1) < 0.5 ? -0.5 : 0.5);
        const dvec3 o = center + (1 + off) * (rim - center) - maker.uniform(-1, 3) * axis;
        cases.which.push_back(static_cast<std::uint32_t>(cases.primitives.size()));
        cases.rays.push_back(make_ray(o, j % 4 < 2 ? axis : axis * maker.uniform(-3, 3)));
      }
      cases.primitives.push_back(p);
    }
    EXPECT_GT(expect_watertight(cases, 8), 4000);
  }
}

const RimCase rim_cases[] = {{shape_cylinder, 8, 0},   {shape_cylinder, 8, 1e3},
                             {shape_cylinder, 8, 1e5}, {shape_cylinder, 1, 1e4},
                             {shape_cone, 8, 0},       {shape_cone, 8, 1e3},
                             {shape_cone, 8, 1e5},     {shape_cone, 1, 1e4}};
INSTANTIATE_TEST_SUITE_P(Kinds, QuadricRims, testing::ValuesIn(rim_cases),
                         [](const auto& instance) {
                           const RimCase& c = instance.param;
                           return fmt::format("{}_{}_at_{:.0f}",
                                              c.shape == shape_cylinder ? "cylinder" : "cone",
                                              c.width, c.away);
                         });

// --- One shape told in two ways ---

constexpr std::uint32_t any_surface = 0xffff;

// Both name the same crossing, each within its bound; `name` turns a's surface into what b should
// say. Close to where two surfaces meet (closer than the two crossings are to each other, and the
// bound) either may be named.
template <class Name>
void expect_same(const Cases& a, const std::vector<FlatPrimitive>& b, const Name& name) {
  const auto first = Probe(test_device(), test_width(), a.primitives).trace(a.which, a.rays),
             second = Probe(test_device(), test_width(), b).trace(a.which, a.rays);
  int hits = 0, named = 0;
  for (std::size_t i = 0; i < first.size(); ++i) {
    const FlatPrimitive& p = a.primitives[a.which[i]];
    const reference::Primitive reference = frustum_of(p);
    const reference::Ray ray = reference_ray(a.rays[i]);
    const double bound = 2 * bound_of(p, a.rays[i]);
    if (is_hit(first[i]) != is_hit(second[i]) || leaves(first[i]) != leaves(second[i])) {
      ASSERT_TRUE(std::abs(reference::value(reference, ray.origin)) <= bound ||
                  reference::referee(reference, ray, bound) == reference::Verdict::tangent)
          << text_of(p, a.rays[i]);
      continue;
    }
    if (!is_hit(first[i])) continue;
    ++hits;
    const double t0 = first[i].hit.t, t1 = second[i].hit.t;
    ASSERT_LE(std::abs(reference::value(reference, ray.origin + 0.5 * (t0 + t1) * ray.direction)),
              bound)
        << text_of(p, a.rays[i]);
    const std::uint32_t expected = name(surface_number(first[i]));
    if (expected == any_surface) continue;
    ++named;
    if (expected == surface_number(second[i])) continue;
    const auto exact = reference::closest(reference, ray);
    if (!exact) continue;
    // A shallow ray that is displaced by the bound meets the surface that much further along it.
    const dvec3 on = ray.origin + exact->t * ray.direction;
    const double slope = std::abs(
        glm::dot(reference::normal_at(reference, on, bound), glm::normalize(ray.direction)));
    const double apart =
        std::max(std::abs(t0 - exact->t), std::abs(t1 - exact->t)) * glm::length(ray.direction);
    ASSERT_LE(exact->surface_margin, apart + bound / slope)
        << fmt::format("surfaces {} and {}, reference {}; t {} {} {}, bound {}\n",
                       surface_number(first[i]), surface_number(second[i]), exact->surface, t0, t1,
                       exact->t, bound)
        << text_of(p, a.rays[i]);
  }
  std::printf("%d hits, %d surfaces\n", hits, named);
  EXPECT_GT(hits, static_cast<int>(first.size() / 4));
}

TEST(QuadricRelations, EndsMayBeSwapped) {
  for (const int shape : {shape_cylinder, shape_cone}) {
    CaseMaker maker(62);
    const Cases cases = random_cases(maker, shape, 200 * test_scale(), 50, 10, true);
    std::vector<FlatPrimitive> swapped;
    for (const FlatPrimitive& p : cases.primitives) {
      const Ends e = ends_of(p);
      swapped.push_back(quadric(shape, {e.p1, e.p0, e.r1, e.r0, e.cap1, e.cap0}));
    }
    expect_same(cases, swapped,
                [](std::uint32_t surface) { return surface == 0 ? 0u : 3 - surface; });
  }
}

TEST(QuadricRelations, RoundEndsMakeACapsule) {
  CaseMaker maker(63);
  for (const int shape : {shape_cylinder, shape_cone}) {
    Cases cases = random_cases(maker, shape, 200 * test_scale(), 50, 10, false);
    std::vector<FlatPrimitive> capsules;
    for (FlatPrimitive& p : cases.primitives) {
      Ends e = ends_of(p);
      e.cap0 = e.cap1 = rounded;
      p = quadric(shape, e);
      FlatPrimitive capsule = p;
      capsule.shape = shape == shape_cylinder ? shape_capsule : shape_tapered_capsule;
      capsules.push_back(capsule);
    }
    expect_same(cases, capsules, [](std::uint32_t) { return any_surface; });
  }
}

TEST(QuadricRelations, EqualRadiiMakeACylinder) {
  CaseMaker maker(64);
  const Cases cylinders = random_cases(maker, shape_cylinder, 300 * test_scale(), 50, 10, true);
  std::vector<FlatPrimitive> cones;
  for (const FlatPrimitive& p : cylinders.primitives)
    cones.push_back(quadric(shape_cone, ends_of(p)));
  expect_same(cylinders, cones, [](std::uint32_t surface) { return surface; });
}

// --- Ends ---

Probed trace_one(const FlatPrimitive& p, const dvec3& o, const dvec3& d) {
  return Probe(test_device(), test_width(), std::vector<FlatPrimitive>{p})
      .trace({0}, {make_ray(o, d)})[0];
}

TEST(QuadricEnds, AreOpenFlatOrRound) {
  const auto cylinder = [](float cap0, float cap1) {
    return quadric(shape_cylinder, {{0, 0, 0}, {0, 0, 4}, 1, 1, cap0, cap1});
  };
  const dvec3 below(0.25, 0, -3), up(0, 0, 1);
  EXPECT_FALSE(is_hit(trace_one(cylinder(open, open), below, up)));
  const Probed inner = trace_one(cylinder(open, flat), below, up);
  EXPECT_TRUE(is_hit(inner) && leaves(inner));
  EXPECT_EQ(surface_number(inner), 2u);
  EXPECT_NEAR(inner.hit.t, 7, 1e-6);
  const Probed base = trace_one(cylinder(flat, open), below, up);
  EXPECT_TRUE(is_hit(base) && !leaves(base));
  EXPECT_EQ(surface_number(base), 1u);
  EXPECT_NEAR(base.hit.t, 3, 1e-6);
  EXPECT_NEAR(trace_one(cylinder(rounded, flat), below, up).hit.t, 3 - std::sqrt(1 - 0.0625), 1e-6);
  // In through the open end, out through the side.
  const Probed side = trace_one(cylinder(open, flat), {0, 0, -1}, {1, 0, 2});
  EXPECT_TRUE(is_hit(side) && leaves(side));
  EXPECT_EQ(surface_number(side), 0u);
  EXPECT_NEAR(side.hit.t, 1, 1e-6);
}

TEST(QuadricEnds, ConesHaveAnApex) {
  const FlatPrimitive cone = quadric(shape_cone, {{0, 0, 0}, {0, 0, 4}, 2, 0, flat, flat});
  EXPECT_NEAR(trace_one(cone, {0, 0, 9}, {0, 0, -1}).hit.t, 5, 1e-5);
  EXPECT_NEAR(trace_one(cone, {5, 0, 2}, {-1, 0, 0}).hit.t, 4, 1e-5);
  // The nappe beyond the apex is not there.
  EXPECT_FALSE(is_hit(trace_one(cone, {5, 0, 5}, {-1, 0, 0})));
  EXPECT_FALSE(is_hit(trace_one(cone, {1, 0, 9}, {0, 0.5, -1})));
  const Probed base = trace_one(cone, {1.5, 0, -1}, {0, 0, 1});
  EXPECT_EQ(surface_number(base), 1u);
  EXPECT_NEAR(base.hit.t, 1, 1e-6);
}

// The hull of a disk and a ball that reaches through it (radius 5 around the origin, disk of radius
// 12 at z = 1): the tangents from the rim (12, 1) touch the ball where the normal's angle is that
// of the rim -+ acos(5 / sqrt(145)).
TEST(QuadricEnds, ABallMayReachThroughTheDisk) {
  const FlatPrimitive shape = quadric(shape_cone, {{0, 0, 0}, {0, 0, 1}, 5, 12, rounded, flat});
  const double angle = std::atan2(1, 12), opening = std::acos(5 / std::sqrt(145.0));
  EXPECT_NEAR(trace_one(shape, {0, 0, 9}, {0, 0, -1}).hit.t, 4, 1e-5);
  for (const double turn : {-opening, opening}) {
    const dvec3 n(std::cos(angle + turn), 0, std::sin(angle + turn));
    const dvec3 on = 0.5 * (5.0 * n + dvec3(12, 0, 1));
    const Probed hit = trace_one(shape, on + 2.0 * n, -n);
    ASSERT_TRUE(is_hit(hit));
    EXPECT_EQ(surface_number(hit), 0u);
    EXPECT_NEAR(hit.hit.t, 2, 1e-5);
    EXPECT_LT(glm::length(point(hit.surface.ng) - n), 1e-6);
    EXPECT_NEAR(hit.surface.v, 0.5, 1e-6);
  }
  // Held by it altogether: one sphere.
  const Probed sphere = trace_one(quadric(shape_cone, {{0, 0, 0}, {0, 0, 3}, 5, 4, rounded, flat}),
                                  {4, 0, 9}, {0, 0, -1});
  EXPECT_EQ(surface_number(sphere), 1u);
  EXPECT_NEAR(sphere.hit.t, 6, 1e-5);
}

// --- Parametrisation ---

// u is the turn around the axis on every surface; v runs from p0 to p1 along each.
TEST(QuadricParameters, FollowTheProfile) {
  const FlatPrimitive cone = quadric(shape_cone, {{0, 0, 0}, {0, 0, 4}, 2, 1, flat, rounded});
  const auto v = [&](const dvec3& o, const dvec3& d) { return trace_one(cone, o, d).surface.v; };
  EXPECT_NEAR(v({0, 0, -1}, {0, 0, 1}), 0, 1e-6);
  EXPECT_NEAR(v({0.5, 0, -1}, {0, 0, 1}), 0.25, 1e-6);
  EXPECT_NEAR(v({1.999, 0, -1}, {0, 0, 1}), 0.9995, 1e-6);
  EXPECT_NEAR(v({9, 0, 1e-6}, {-1, 0, 0}), 0, 1e-5);
  EXPECT_NEAR(v({0, 0, 9}, {0, 0, -1}), 1, 1e-6);
  EXPECT_NEAR(v({0, 0.001, 9}, {0, 0, -1}), 1, 1e-3);
  // Rim to rim at one turn: a point of the base, of the side and of the ball, a quarter turn from
  // each other's frame.
  const dvec3 n = glm::normalize(dvec3(0.6, 0.8, 0));
  const float u = trace_one(cone, 9.0 * n + dvec3(0, 0, 1), -n).surface.u;
  EXPECT_NEAR(trace_one(cone, n + dvec3(0, 0, -9), {0, 0, 1}).surface.u, u, 1e-6);
  EXPECT_NEAR(trace_one(cone, 0.5 * n + dvec3(0, 0, 9), {0, 0, -1}).surface.u, u, 1e-6);
}

// Between two points nearby p changes by dpdu du + dpdv dv, up to the square of their distance over
// the radius there.
TEST(QuadricParameters, DerivativesMatchDifferences) {
  CaseMaker maker(65);
  const float caps[] = {flat, rounded, open};
  std::vector<FlatPrimitive> primitives;
  for (const float cap0 : caps)
    for (const float cap1 : caps)
      for (const double length : {0.5, 3.0}) {
        primitives.push_back(
            quadric(shape_cylinder,
                    {{1, 2, 3}, dvec3(1, 2, 3) + length * maker.direction(), 1, 1, cap0, cap1}));
        primitives.push_back(
            quadric(shape_cone,
                    {{1, 2, 3}, dvec3(1, 2, 3) + length * maker.direction(), 1, 2, cap0, cap1}));
        primitives.push_back(
            quadric(shape_cone,
                    {{1, 2, 3}, dvec3(1, 2, 3) + length * maker.direction(), 2, 0, cap0, cap1}));
      }
  constexpr double step = 2e-3;
  std::vector<std::uint32_t> which;
  std::vector<RayRecord> rays, beside;
  for (std::uint32_t i = 0; i < primitives.size(); ++i)
    for (int j = 0; j < 300; ++j) {
      const Ends e = ends_of(primitives[i]);
      const dvec3 inside =
          e.p0 + maker.uniform(-0.5, 1.5) * (e.p1 - e.p0) + maker.uniform(0, 1) * maker.direction();
      const dvec3 o = inside + 6.0 * maker.direction(), d = inside - o;
      which.push_back(i);
      rays.push_back(make_ray(o, d));
      beside.push_back(make_ray(o + step * maker.direction(), d));
    }
  const Probe probe(test_device(), test_width(), primitives);
  const auto first = probe.trace(which, rays), second = probe.trace(which, beside);
  int checked[3] = {0, 0, 0};
  for (std::size_t i = 0; i < first.size(); ++i) {
    const SurfaceOut &a = first[i].surface, &b = second[i].surface;
    if (!is_hit(first[i]) || !is_hit(second[i]) || first[i].hit.surface != second[i].hit.surface)
      continue;
    const dvec3 moved = point(b.p) - point(a.p), dpdu = point(a.dpdu), dpdv = point(a.dpdv);
    const double radius = glm::length(dpdu) / 6.283185307179586;
    // Away from poles and the seam, and not over the rim of a disk with a ball behind.
    if (radius < 0.1 || std::abs(a.u - b.u) > 0.5 || glm::dot(point(a.ng), point(b.ng)) < 0.9 ||
        glm::length(moved) > 10 * step)
      continue;
    const dvec3 expected = double(b.u - a.u) * dpdu + double(b.v - a.v) * dpdv;
    ASSERT_LE(glm::length(moved - expected), glm::dot(moved, moved) / radius + 1e-5)
        << text_of(primitives[which[i]], rays[i]);
    ++checked[surface_number(first[i])];
    // Both lie in the tangent plane, as far as a unit normal (16 eps), their own few roundings and
    // those of the ends' coordinates (up to 8, 4 eps) let them.
    ASSERT_NEAR(glm::dot(dpdu, point(a.ng)), 0, 32 * 0x1p-24 * (1 + glm::length(dpdu)));
    ASSERT_NEAR(glm::dot(dpdv, point(a.ng)), 0, 32 * 0x1p-24 * (1 + glm::length(dpdv)));
  }
  for (const int count : checked) EXPECT_GT(count, 1000);
}

// dpdu x dpdv points outward on every surface (but for the second part of a side that has one).
TEST(QuadricParameters, AreRightHanded) {
  const FlatPrimitive cone = quadric(shape_cone, {{0, 0, 0}, {0, 0, 4}, 2, 1, flat, rounded});
  const std::pair<dvec3, dvec3> rays[] = {
      {{1, 0.3, -9}, {0, 0, 1}}, {{9, 1, 2}, {-1, 0, 0}}, {{0.4, 0.2, 9}, {0, 0, -1}}};
  std::uint32_t surfaces = 0;
  for (const auto& [o, d] : rays) {
    const Probed hit = trace_one(cone, o, d);
    surfaces |= 1u << surface_number(hit);
    const dvec3 outward =
        glm::normalize(glm::cross(point(hit.surface.dpdu), point(hit.surface.dpdv)));
    EXPECT_LT(glm::length(outward - point(hit.surface.ng)), 1e-5);
  }
  EXPECT_EQ(surfaces, 7u);
}

}  // namespace
}  // namespace caplet::test::quadrics_test
