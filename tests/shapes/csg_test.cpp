// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Csg shapes: hit lists and surfaces on the device against the reference, and identities between
// shapes.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <cmath>
#include <cstdlib>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <mutex>
#include <random>

#include "csg_cases.h"
#include "reference/solver.h"
#include "support/test_device.h"
#include "support/test_scale.h"

namespace caplet::test {
namespace {

using glm::dmat4;
using glm::dvec3;

constexpr std::uint32_t capacity = 72;  // 32 solids have 64 crossings

std::string text_of(const RayRecord& r) {
  return fmt::format("ray {:a} {:a} {:a}  {:a} {:a} {:a}", r.ox, r.oy, r.oz, r.dx, r.dy, r.dz);
}

struct Counts {
  std::size_t rays = 0, hits = 0, leaving_first = 0, many = 0, failures = 0;
};

Counts check(const Shape& shape, std::span<const RayRecord> rays, int width,
             const std::string& what) {
  const reference::Primitive reference = reference_of_shape(shape);
  const CsgBound bound(shape);
  const std::vector<RayList> lists = list_tracer(width).trace(flat_scene(shape), rays, capacity);
  Counts counts;
  std::mutex mutex;
  tbb::parallel_for(std::size_t(0), rays.size(), [&](std::size_t i) {
    const std::string wrong = csg_disagreement(shape, reference, bound, rays[i], lists[i]);
    const std::lock_guard lock(mutex);
    ++counts.rays;
    counts.hits += lists[i].hits.size();
    counts.leaving_first += !lists[i].hits.empty() && is_leaving(lists[i].hits[0]);
    counts.many += lists[i].hits.size() > 2;
    if (!wrong.empty() && counts.failures++ < 3)
      ADD_FAILURE() << what << ": " << wrong << "\n" << text_of(rays[i]);
  });
  return counts;
}

void add(Counts& sum, const Counts& more) {
  sum.rays += more.rays;
  sum.hits += more.hits;
  sum.leaving_first += more.leaving_first;
  sum.many += more.many;
  sum.failures += more.failures;
}

void check_random(int width, int shapes, int rays, int depth, int most, bool affine,
                  std::uint32_t seed) {
  CsgMaker maker(seed);
  Counts sum;
  for (int i = 0; i < shapes * test_scale() && sum.failures < 20; ++i) {
    Shape shape = *maker.csg(depth, most, affine);
    shape.world_from_object =
        maker.placement(maker.below(3) == 0 ? 100 : 1, affine) * shape.world_from_object;
    add(sum, check(shape, maker.rays(shape, rays), width, fmt::format("shape {}", i)));
  }
  std::printf(
      "%zu rays, %zu crossings, %zu begin inside, %zu cross more than twice, %zu failures\n",
      sum.rays, sum.hits, sum.leaving_first, sum.many, sum.failures);
  EXPECT_EQ(sum.failures, 0u);
  EXPECT_GT(sum.hits, sum.rays / 5);
  EXPECT_GT(sum.leaving_first, sum.rays / 100);
  EXPECT_GT(sum.many, sum.rays / 100);
}

TEST(Csg, TwoToFourSolids) { check_random(8, 150, 300, 1, 4, false, 1); }
TEST(Csg, NestedFourDeep) { check_random(8, 100, 300, 4, 32, false, 2); }
TEST(Csg, AffineOperands) { check_random(8, 150, 300, 2, 8, true, 3); }
TEST(Csg, OneAtATime) { check_random(1, 60, 200, 3, 16, true, 4); }

// --- Identities ---

std::vector<RayList> lists_of(const Shape& shape, std::span<const RayRecord> rays,
                              int width = test_width()) {
  return list_tracer(width).trace(flat_scene(shape), rays, capacity);
}

/// Both shapes are the same solid: the same crossings, to within the bounds of both at the surface;
/// surfaces may be numbered apart.
void expect_same_solid(const Shape& a, const Shape& b, std::span<const RayRecord> rays,
                       const std::string& what) {
  const auto first = lists_of(a, rays), second = lists_of(b, rays);
  const reference::Primitive reference = reference_of_shape(a);
  const CsgBound bound_a(a), bound_b(b);
  std::size_t crossings = 0, failures = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const reference::Ray ray{
        {rays[i].ox, rays[i].oy, rays[i].oz}, {rays[i].dx, rays[i].dy, rays[i].dz}, 0, HUGE_VAL};
    const double bound = bound_a(ray.origin) + bound_b(ray.origin);
    bool same = first[i].hits.size() == second[i].hits.size();
    for (std::size_t k = 0; same && k < first[i].hits.size(); ++k) {
      const HitRecord &x = first[i].hits[k], &y = second[i].hits[k];
      const double between = 0.5 * (double(x.t) + double(y.t));
      same = is_leaving(x) == is_leaving(y) &&
             std::abs(reference::value(reference, ray.origin + between * ray.direction)) <= bound;
      ++crossings;
    }
    // Where one sees what the other does not, the shape is grazed: each answer holds within its
    // bound (csg_disagreement).
    if (!same)
      same = csg_disagreement(a, reference, bound_a, rays[i], first[i]).empty() &&
             csg_disagreement(a, reference, bound_a, rays[i], second[i]).empty();
    if (!same && failures++ < 3) ADD_FAILURE() << what << ", ray " << i << ": " << text_of(rays[i]);
  }
  EXPECT_EQ(failures, 0u) << what;
  EXPECT_GT(crossings, rays.size() / 10) << what;
}

BoxShape box(const dvec3& p0, const dvec3& p1) { return BoxShape{p0, p1}; }

TEST(CsgIdentities, DifferenceIsIntersectionWithTheComplement) {
  CsgMaker maker(21);
  for (int i = 0; i < 40; ++i) {
    const auto a = maker.solid(false);
    const double at = maker.uniform(-0.3, 0.3);
    // Everything around a lies within 9 of the origin: both boxes are half-spaces to it.
    const auto below = operand(box(dvec3(-9, -9, -9), dvec3(9, 9, at))),
               above = operand(box(dvec3(-9, -9, at), dvec3(9, 9, 9)));
    const dmat4 placed = maker.placement(3, i % 2 == 0);
    const Shape difference = csg_shape(Operation::set_difference, {a, above}, placed);
    const Shape intersection = csg_shape(Operation::set_intersection, {a, below}, placed);
    const std::vector<RayRecord> rays =
        maker.rays(csg_shape(Operation::set_union, {a}, placed), 200);
    const auto first = lists_of(difference, rays), second = lists_of(intersection, rays);
    const reference::Primitive reference = reference_of_shape(difference);
    const CsgBound bound(difference);
    for (std::size_t k = 0; k < rays.size(); ++k) {
      EXPECT_EQ(csg_disagreement(difference, reference, bound, rays[k], first[k]), "")
          << i << " " << text_of(rays[k]);
      ASSERT_EQ(first[k].hits.size(), second[k].hits.size()) << i << " " << text_of(rays[k]);
      for (std::size_t n = 0; n < first[k].hits.size(); ++n) {
        // Their boxes, and with them the roundings, differ.
        const double t = 0.5 * (double(first[k].hits[n].t) + double(second[k].hits[n].t));
        const dvec3 o(rays[k].ox, rays[k].oy, rays[k].oz), d(rays[k].dx, rays[k].dy, rays[k].dz);
        EXPECT_LE(std::abs(reference::value(reference, o + t * d)), bound(o));
        EXPECT_EQ(is_leaving(first[k].hits[n]), is_leaving(second[k].hits[n]));
        // The cut is the lower face of the box taken away and the upper one of the box kept.
        const std::uint32_t own = static_cast<std::uint32_t>(surface_count(*a));
        const std::uint32_t x = surface_number(first[k].hits[n]),
                            y = surface_number(second[k].hits[n]);
        EXPECT_EQ(x < own ? x : own + 5, y);
        if (x >= own) {
          for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(first[k].surfaces[n].ng[c], second[k].surfaces[n].ng[c], 1e-6);
        }
      }
    }
  }
}

TEST(CsgIdentities, OneOperandIsItself) {
  CsgMaker maker(22);
  for (int i = 0; i < 40; ++i) {
    const auto a = maker.solid(i % 2 == 0);
    const dmat4 placed = maker.placement(i % 3 == 0 ? 50 : 2, i % 2 == 0);
    Shape plain = *a;
    plain.world_from_object = placed * a->world_from_object;
    const Shape wrapped = csg_shape(static_cast<Operation>(i % 3), {a}, placed);
    const std::vector<RayRecord> rays = maker.rays(wrapped, 200);
    expect_same_solid(wrapped, plain, rays, fmt::format("solid {}", i));
  }
}

TEST(CsgIdentities, OrderOfUnionAndIntersectionDoesNotMatter) {
  CsgMaker maker(23);
  for (int i = 0; i < 40; ++i) {
    const std::vector<std::shared_ptr<const Shape>> solids = {maker.solid(true), maker.solid(true),
                                                              maker.solid(true)};
    const auto operation = i % 2 == 0 ? Operation::set_union : Operation::set_intersection;
    const Shape forward = csg_shape(operation, solids),
                backward = csg_shape(operation, {solids[2], solids[1], solids[0]});
    const Shape nested =
        csg_shape(operation, {operand(CsgShape{operation, {solids[0], solids[1]}}), solids[2]});
    const std::vector<RayRecord> rays = maker.rays(csg_shape(Operation::set_union, solids), 200);
    for (const Shape* other : {&backward, &nested}) {
      const auto first = lists_of(forward, rays), second = lists_of(*other, rays);
      for (std::size_t k = 0; k < rays.size(); ++k)
        ASSERT_EQ(first[k].hits.size(), second[k].hits.size()) << text_of(rays[k]);
    }
  }
}

// --- Solids that touch ---

/// No gap that the reference does not see: between leaving and entering again it must be outside
/// somewhere.
std::size_t false_gaps(const Shape& shape, std::span<const RayRecord> rays,
                       const std::vector<RayList>& lists) {
  const reference::Primitive reference = reference_of_shape(shape);
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const reference::Ray ray{
        {rays[i].ox, rays[i].oy, rays[i].oz}, {rays[i].dx, rays[i].dy, rays[i].dz}, 0, HUGE_VAL};
    for (std::size_t k = 0; k + 1 < lists[i].hits.size(); ++k) {
      if (!is_leaving(lists[i].hits[k])) continue;
      bool gap = false;
      for (int n = 0; n <= 32 && !gap; ++n) {
        const double t = double(lists[i].hits[k].t) +
                         (double(lists[i].hits[k + 1].t) - double(lists[i].hits[k].t)) * n / 32;
        gap = reference::value(reference, ray.origin + t * ray.direction) > 0;
      }
      if (!gap && wrong++ < 3)
        ADD_FAILURE() << "an inner surface, ray " << i << ": " << text_of(rays[i]);
    }
  }
  return wrong;
}

TEST(CsgTouching, RowOfBoxesIsOneBox) {
  CsgMaker maker(31);
  for (int i = 0; i < 30; ++i) {
    const dmat4 placed = i == 0 ? dmat4(1) : maker.placement(i % 2 == 0 ? 30 : 1, i % 3 == 0);
    std::vector<std::shared_ptr<const Shape>> boxes;
    for (int k = 0; k < 10; ++k)
      boxes.push_back(operand(box(dvec3(0.1 * k, 0, 0), dvec3(0.1 * (k + 1), 0.4, 0.3))));
    const Shape row = csg_shape(Operation::set_union, boxes, placed);
    const Shape one =
        csg_shape(Operation::set_union, {operand(box(dvec3(0), dvec3(1, 0.4, 0.3)))}, placed);
    const std::vector<RayRecord> rays = maker.rays(one, 600);
    const auto lists = lists_of(row, rays), whole = lists_of(one, rays);
    const reference::Primitive row_reference = reference_of_shape(row),
                               one_reference = reference_of_shape(one);
    const CsgBound row_bound(row), one_bound(one);
    for (std::size_t k = 0; k < rays.size(); ++k) {
      EXPECT_LE(lists[k].hits.size(), 2u) << i << ", " << text_of(rays[k]);
      EXPECT_EQ(csg_disagreement(row, row_reference, row_bound, rays[k], lists[k]), "")
          << text_of(rays[k]);
      EXPECT_EQ(csg_disagreement(one, one_reference, one_bound, rays[k], whole[k]), "")
          << text_of(rays[k]);
    }
  }
}

// Each box by its own rotation, so that the shared faces agree to rounding alone.
TEST(CsgTouching, BoxesUnderDifferentTransforms) {
  CsgMaker maker(32);
  std::size_t crossings = 0;
  for (int i = 0; i < 40; ++i) {
    const dmat4 placed = maker.placement(1, i % 2 == 0);
    std::vector<std::shared_ptr<const Shape>> boxes;
    for (int k = 0; k < 4; ++k) {
      const dmat4 turned = glm::rotate(
          glm::scale(glm::translate(dmat4(1), dvec3(0.3 * k, 0, 0)), dvec3(0.3, 0.4, 0.4)),
          1.5707963267948966 * k, dvec3(1, 0, 0));
      boxes.push_back(operand(box(dvec3(0, -1, -1), dvec3(1)), turned));
    }
    const Shape row = csg_shape(Operation::set_union, boxes, placed);
    const std::vector<RayRecord> rays = maker.rays(row, 500);
    const auto lists = lists_of(row, rays);
    EXPECT_EQ(false_gaps(row, rays, lists), 0u);
    for (const RayList& list : lists) {
      EXPECT_LE(list.hits.size(), 2u);
      crossings += list.hits.size();
    }
    // The opposite: nothing is common to neighbours.
    for (const RayList& list :
         lists_of(csg_shape(Operation::set_intersection, {boxes[0], boxes[1]}, placed), rays))
      EXPECT_TRUE(list.hits.empty());
  }
  EXPECT_GT(crossings, 10000u);
}

TEST(CsgTouching, ChainOfCapsules) {
  CsgMaker maker(33);
  std::size_t crossings = 0;
  for (int i = 0; i < 40; ++i) {
    std::vector<std::shared_ptr<const Shape>> parts;
    dvec3 at(0), ahead = maker.direction();
    double radius = 0.3;
    const bool tapered = i % 2 == 1, straight = i % 4 == 0;
    for (int k = 0; k < 12; ++k) {
      if (!straight) ahead = glm::normalize(ahead + 0.8 * maker.direction());
      const dvec3 next = at + maker.uniform(0.2, 0.8) * ahead;
      const double end = tapered ? radius * maker.uniform(0.8, 1.2) : radius;
      CapsulesShape one;
      one.p0 = {glm::vec3(at)};
      one.p1 = {glm::vec3(next)};
      one.radius0 = {static_cast<float>(radius)};
      if (tapered) one.radius1 = {static_cast<float>(end)};
      parts.push_back(operand(one));
      at = next;
      radius = end;
    }
    const Shape chain =
        csg_shape(Operation::set_union, parts, maker.placement(i % 3 == 0 ? 20 : 1, i % 5 == 0));
    const std::vector<RayRecord> rays = maker.rays(chain, 500);
    const auto lists = lists_of(chain, rays);
    EXPECT_EQ(false_gaps(chain, rays, lists), 0u);
    const reference::Primitive reference = reference_of_shape(chain);
    const CsgBound bound(chain);
    for (std::size_t k = 0; k < rays.size(); ++k) {
      EXPECT_EQ(csg_disagreement(chain, reference, bound, rays[k], lists[k]), "")
          << text_of(rays[k]);
      if (straight && !tapered) {
        EXPECT_LE(lists[k].hits.size(), 2u) << text_of(rays[k]);
      }
      crossings += lists[k].hits.size();
    }
  }
  EXPECT_GT(crossings, 3000u);
}

// A pocket as high as the block: no skin is left on top, from either side.
TEST(CsgTouching, FlushPocketHasNoSkin) {
  CsgMaker maker(34);
  for (int i = 0; i < 30; ++i) {
    const dmat4 placed = maker.placement(i % 2 == 0 ? 30 : 1, i % 3 == 0);
    const auto block = operand(box(dvec3(0), dvec3(1)));
    const auto pocket = i % 2 == 0
                            ? operand(box(dvec3(0.2, 0.2, 0.5), dvec3(0.8, 0.8, 1)))
                            : operand(box(dvec3(-0.3, -0.3, -0.25), dvec3(0.3, 0.3, 0.25)),
                                      glm::rotate(glm::translate(dmat4(1), dvec3(0.5, 0.5, 0.75)),
                                                  0.7, dvec3(0, 0, 1)));
    const Shape shape = csg_shape(Operation::set_difference, {block, pocket}, placed);
    std::vector<RayRecord> rays;
    for (int k = 0; k < 500; ++k) {
      // Down through the opening to the bottom.
      const dvec3 bottom(maker.uniform(0.35, 0.65), maker.uniform(0.35, 0.65), 0.5);
      const dvec3 opening(maker.uniform(0.35, 0.65), maker.uniform(0.35, 0.65), 1);
      const dvec3 o = bottom + maker.uniform(1.5, 8) * (opening - bottom);
      const dvec3 from = dvec3(placed * glm::dvec4(o, 1)),
                  to = dvec3(placed * glm::dvec4(bottom, 1));
      rays.push_back(make_ray(from, to - from));
    }
    const auto lists = lists_of(shape, rays);
    for (std::size_t k = 0; k < rays.size(); ++k) {
      ASSERT_EQ(lists[k].hits.size(), 2u) << text_of(rays[k]);
      EXPECT_NEAR(double(lists[k].hits[0].t), 1, 1e-3);
      EXPECT_EQ(surface_number(lists[k].hits[0]), 6u + 4u);  // the pocket's bottom
    }
  }
}

// Thicker than twice the bound, a wall is there.
TEST(Csg, ThinWallsAreKept) {
  for (const double wall : {3e-5, 1e-3}) {
    const Shape shell = csg_shape(Operation::set_difference,
                                  {operand(SphereShape{1}), operand(SphereShape{1 - wall})});
    CsgMaker maker(41);
    std::vector<RayRecord> rays;
    for (int k = 0; k < 500; ++k) rays.push_back(make_ray(3.0 * maker.direction(), dvec3(0)));
    for (RayRecord& r : rays) r.dx = -r.ox, r.dy = -r.oy, r.dz = -r.oz;
    for (const RayList& list : lists_of(shell, rays)) {
      ASSERT_EQ(list.hits.size(), 4u);
      for (std::size_t k = 0; k < 4; ++k) {
        EXPECT_EQ(is_leaving(list.hits[k]), k % 2 == 1);
        EXPECT_EQ(surface_number(list.hits[k]), k == 1 || k == 2 ? 1u : 0u);
      }
    }
  }
}

// A ray that leaves a surface by its error bound begins on the side it was sent to: outside,
// nothing is left; inside, nothing is entered.
TEST(Csg, RaysFromTheSurfaceBeginOnTheirSide) {
  CsgMaker maker(51);
  std::size_t left = 0, wrong = 0;
  for (int i = 0; i < 150; ++i) {
    Shape shape = *maker.csg(2, 8, i % 2 == 0);
    shape.world_from_object =
        maker.placement(i % 3 == 0 ? 100 : 1, i % 2 == 0) * shape.world_from_object;
    const reference::Primitive reference = reference_of_shape(shape);
    const CsgBound bound(shape);
    const std::vector<RayRecord> rays = maker.rays(shape, 200);
    std::vector<RayRecord> next;
    std::vector<bool> outward;
    for (const RayList& list : lists_of(shape, rays))
      for (const CrossingSurface& s : list.surfaces) {
        const dvec3 p(s.p[0], s.p[1], s.p[2]), n(s.ng[0], s.ng[1], s.ng[2]);
        const bool out = maker.below(2) == 0;
        dvec3 d = maker.direction();
        if ((glm::dot(d, n) > 0) != out) d = -d;
        // Within the bound of another surface that one may be taken for this; the ray stays within
        // it of this one for bound / cosine.
        if (!(reference::surface_at(reference, p).margin * std::abs(glm::dot(d, n)) > bound(p)))
          continue;
        const dvec3 o = p + (out ? 1.0 : -1.0) * double(s.error) * n;
        RayRecord r = make_ray(o, d);
        float* to[] = {&r.ox, &r.oy, &r.oz};
        for (int k = 0; k < 3; ++k)
          *to[k] = std::nextafter(*to[k], n[k] * (out ? 1 : -1) > 0 ? HUGE_VALF : -HUGE_VALF);
        next.push_back(r);
        outward.push_back(out);
      }
    if (next.empty()) continue;
    const auto lists = lists_of(shape, next);
    for (std::size_t k = 0; k < next.size(); ++k) {
      ++left;
      const bool begins_inside = !lists[k].hits.empty() && is_leaving(lists[k].hits[0]);
      if (begins_inside == outward[k] && wrong++ < 5)
        ADD_FAILURE() << "shape " << i << (outward[k] ? " outward " : " inward ")
                      << text_of(next[k]) << " value "
                      << reference::value(reference, dvec3(next[k].ox, next[k].oy, next[k].oz));
    }
  }
  std::printf("%zu rays from surfaces, %zu on the wrong side\n", left, wrong);
  EXPECT_EQ(wrong, 0u);
  EXPECT_GT(left, 5000u);
}

TEST(Csg, TooManySolidsAndOpenOperandsAreErrors) {
  std::vector<std::shared_ptr<const Shape>> many(33, operand(SphereShape{1}));
  EXPECT_THROW(flat_scene(csg_shape(Operation::set_union, many)), InputError);
  many.pop_back();
  EXPECT_NO_THROW(flat_scene(csg_shape(Operation::set_union, many)));
  EXPECT_THROW(
      flat_scene(csg_shape(Operation::set_union, {operand(SphereShape{1}), operand(DiskShape{})})),
      InputError);
  EXPECT_THROW(flat_scene(csg_shape(
                   Operation::set_union,
                   {operand(CylinderShape{dvec3(0), dvec3(1), 1, {Cap::open, Cap::flat}})})),
               InputError);
}

TEST(Csg, NothingInCommonIsNothing) {
  const Shape nothing = csg_shape(Operation::set_intersection, {operand(box(dvec3(0), dvec3(1))),
                                                                operand(box(dvec3(2), dvec3(3)))});
  CsgMaker maker(61);
  for (const RayList& list : lists_of(
           nothing,
           maker.rays(csg_shape(Operation::set_union, {operand(box(dvec3(0), dvec3(3)))}), 300)))
    EXPECT_TRUE(list.hits.empty());
}

// The box of an intersection or a difference is what is left, not what it is made from.
TEST(Csg, BoundsAreTight) {
  const auto big = operand(box(dvec3(-100), dvec3(100))), small = operand(SphereShape{1}),
             beside = operand(box(dvec3(0), dvec3(2)));
  for (const auto& [shape, low, high] :
       {std::tuple(csg_shape(Operation::set_intersection, {big, small}), -1.0, 1.0),
        std::tuple(csg_shape(Operation::set_difference, {small, operand(box(dvec3(5), dvec3(6)))}),
                   -1.0, 1.0),
        std::tuple(csg_shape(Operation::set_intersection, {small, beside}), 0.0, 1.0)}) {
    const FlatScene scene = flat_scene(shape);
    const double radius = double(scene.world.radius), center = double(scene.world.center_x);
    EXPECT_NEAR(center, 0.5 * (low + high), 1e-3);
    EXPECT_NEAR(radius, 0.5 * std::sqrt(3.0) * (high - low), 1e-3);
  }
}

// Caps of balls, cut off by a plane of a box: its side moves to 1/64 of the box, those around the
// rim to 1/16.
TEST(Csg, BoundsOfWhatIsCutOff) {
  for (const double at : {-0.4, 0.1, 0.7}) {
    const auto cut = operand(box(dvec3(-3), dvec3(at, 3, 3)));
    const double rim = at < 0 ? 1 : std::sqrt(1 - at * at);
    for (const auto& ball : {operand(SphereShape{1}),
                             operand(CapsulesShape{{{0, 0, 0}}, {{0, 0, 1e-6F}}, {1}, {}, {}})}) {
      const Shape cap = csg_shape(Operation::set_difference, {ball, cut});
      const Bounds bounds = bounds_of(cap);
      EXPECT_LE(bounds.min.x, at);
      EXPECT_GE(bounds.min.x, at - 2.0 / 64);
      EXPECT_GE(bounds.max.x, 1);
      EXPECT_LE(bounds.max.x, 1 + 2.0 / 64);
      for (const int side : {1, 2}) {
        EXPECT_GE(bounds.max[side], rim);
        EXPECT_LE(bounds.max[side], rim + 2.0 / 16);
        EXPECT_LE(bounds.min[side], -rim);
        EXPECT_GE(bounds.min[side], -rim - 2.0 / 16);
      }
    }
  }
}

TEST(Csg, CapsulesAreNearAsTheirNearestBall) {
  std::mt19937 random(67);
  std::uniform_real_distribution<double> within(-3, 3);
  // The last holds its other ball.
  for (const float radius : {0.5F, 0.2F, 1.1F, 3.1F}) {
    const CapsulesShape pill{{{-1, 0.5F, 0}}, {{1, 0, 0.5F}}, {0.5F}, {radius}, {}};
    for (int i = 0; i < 100; ++i) {
      const dvec3 p(within(random), within(random), within(random));
      double least = HUGE_VAL;
      for (int k = 0; k <= 2000; ++k) {
        const double s = k / 2000.0;
        least = std::min(least, glm::length(p - glm::mix(dvec3(-1, 0.5, 0), dvec3(1, 0, 0.5), s)) -
                                    ((1 - s) * 0.5 + s * double(radius)));
      }
      // Balls 1/2000 apart: their distances change by less than 5 / 2000 in between.
      EXPECT_LE(beyond(pill, p).most, least + 1e-12);
      EXPECT_GE(beyond(pill, p).least, least - 0.5 * 5.0 / 2000);
    }
  }
}

TEST(Csg, IsEmptyWhereNothingIsLeft) {
  const auto empty = [](Operation operation, const Geometry& first, const Geometry& second) {
    const Shape shape = csg_shape(operation, {operand(first), operand(second)});
    const bool found = is_empty(std::get<CsgShape>(shape.geometry), glm::dmat4(1));
    EXPECT_EQ(bounds_of(shape).empty(), found);
    return found;
  };
  const CapsulesShape pill{{{-1, 0, 0}}, {{1, 0, 0}}, {0.5F}, {0.4F}, {}};
  EXPECT_TRUE(empty(Operation::set_difference, box(dvec3(-0.2), dvec3(0.2)), pill));
  EXPECT_TRUE(empty(Operation::set_difference, pill, box(dvec3(-1.6), dvec3(1.6))));
  EXPECT_FALSE(empty(Operation::set_difference, pill, box(dvec3(-1.6), dvec3(1.3, 2, 2))));
  EXPECT_FALSE(empty(Operation::set_difference, SphereShape{1}, pill));
  for (const int axis : {0, 1, 2}) {
    dvec3 apart(0.5), beside(0.5);
    apart[axis] = 2;
    beside[axis] = 0.9;
    const BoxShape unit = box(dvec3(0), dvec3(1));
    EXPECT_TRUE(empty(Operation::set_intersection, unit, box(apart, apart + 1.0)));
    EXPECT_FALSE(empty(Operation::set_intersection, unit, box(beside, beside + 1.0)));
  }
  // Their boxes meet, they do not.
  EXPECT_TRUE(empty(Operation::set_intersection, SphereShape{1}, box(dvec3(0.7), dvec3(1.7))));
}

}  // namespace
}  // namespace caplet::test
