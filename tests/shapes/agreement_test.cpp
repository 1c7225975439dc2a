// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Nearest hit, any hit and the full hit list of every kind of shape against the witness, by themselves and under random affine
// maps, ray by ray. 20,000 rays a test; CAPLET_TEST_SCALE=50 makes it a million.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <mutex>

#include "cases.h"
#include "shared/kinds.h"

namespace caplet::test {
namespace {

using glm::dvec3;

constexpr double eps = 0x1p-24;
constexpr std::uint32_t capacity = 24;

const Device& device() {
  static const Device chosen = Device::choose("");
  return chosen;
}

struct Tally {
  std::mutex mutex;
  std::uint64_t rays = 0, crossings = 0, excused = 0, failures = 0;
  double worst = 0;
};

bool is_leaving(const HitRecord& hit) { return (hit.surface & CAPLET_LEAVING) != 0; }

/// One ray in the space of its primitive, and the bound that holds there.
struct Case {
  const FlatPrimitive* primitive;
  const reference::Primitive* witness;
  reference::Ray ray;
  double bound;
  dvec3 at(double t) const { return ray.origin + t * ray.direction; }
  double value(double t) const { return reference::value(*witness, at(t)); }
  /// Whether the line comes within the bound of touching, or of a rim.
  bool touches() const { return reference::referee(*witness, ray, bound) == reference::Verdict::tangent; }
};

/// The hit lies on the shape and on the surface that it names. Returns what is wrong, or an empty text.
std::string wrong_place(const Case& c, const HitRecord& hit, double* ratio) {
  const double off = std::abs(c.value(hit.t));
  *ratio = off / c.bound;
  if (!(off <= c.bound)) {
    // Edge-on, triangles and patches are met beside themselves.
    const bool sheet = c.primitive->shape == shape_triangle || c.primitive->shape == shape_bilinear;
    *ratio = 0;
    if (!(sheet && off <= reference::bounding_ball(*c.witness).radius && c.touches()))
      return fmt::format("the hit at {} is {} off the surface, allowed {}", hit.t, off, c.bound);
    return {};
  }
  const auto surface = static_cast<int>(hit.surface & CAPLET_SURFACE_MASK);
  if (const double away = reference::distance_from_surface(*c.witness, c.at(hit.t), surface);
      reference::surface_count(*c.witness) > 1 && !(away <= 2 * c.bound))
    return fmt::format("the hit at {} is {} from surface {}, allowed {}", hit.t, away, surface, 2 * c.bound);
  return {};
}

/// Csg shapes: between the crossings of the list the ray is nowhere further than `slack` on the wrong side. Crossings of the list
/// come in turns.
std::string wrong_way(const Case& c, const std::vector<HitRecord>& list, double slack) {
  const auto crossings = reference::crossings(*c.witness, c.ray);
  bool inside = !list.empty() && is_leaving(list[0]);
  for (std::size_t i = 0; i < list.size(); ++i)
    if (is_leaving(list[i]) != (inside == (i % 2 == 0))) return fmt::format("crossing {} does not take turns", i);
  double last = 0;
  for (std::size_t i = 0; i <= list.size(); ++i, inside = !inside) {
    const double end = i < list.size() ? double(list[i].t) : HUGE_VAL;
    // Stretches between crossings of the witness, with what lies before the first and behind the last, on the other side.
    for (std::size_t k = 0; k <= crossings.size(); ++k) {
      const bool witness_inside = k > 0 && !crossings[k - 1].leaving;
      if (witness_inside == inside) continue;
      double low = k > 0 ? crossings[k - 1].t : -HUGE_VAL, high = k < crossings.size() ? crossings[k].t : HUGE_VAL;
      low = std::max(low, last);
      high = std::min(high, end);
      if (!(low < high)) continue;
      if (!std::isfinite(high)) return fmt::format("inside behind {}, where nothing is", last);
      constexpr int samples = 64;
      for (int n = 1; n < samples; ++n)
        if (const double t = low + (high - low) * n / samples; std::abs(c.value(t)) > slack)
          return fmt::format("said to be {} at {}, where the value is {}; allowed {}", inside ? "inside" : "outside", t,
                             c.value(t), slack);
    }
    last = end;
  }
  return {};
}

/// Crossings of witness and device side by side: the same number, each between the same sides, at the same place of the surface.
std::string different(const Case& c, const std::vector<reference::Crossing>& expected, const std::vector<HitRecord>& list) {
  if (expected.size() != list.size()) return fmt::format("{} crossings, the witness says {}", list.size(), expected.size());
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (expected[i].leaving != is_leaving(list[i]))
      return fmt::format("crossing {} at {} leaving {}, the witness says {} at {}", i, list[i].t, is_leaving(list[i]),
                         expected[i].leaving, expected[i].t);
    // Between both parameters the ray stays near the surface.
    if (!(std::abs(c.value(0.5 * (expected[i].t + double(list[i].t)))) <= 2 * c.bound))
      return fmt::format("crossing {} at {}, the witness says {}", i, list[i].t, expected[i].t);
  }
  return {};
}

void check(const Case& c, const Listed& listed, const std::string& where, Tally& tally) {
  std::string wrong;
  const auto note = [&](std::string text) {
    if (wrong.empty()) wrong = std::move(text);
  };
  const bool hit = listed.nearest.slot != CAPLET_NONE;
  if (listed.count > capacity) note("more crossings than the list holds");
  // Where the ray begins at the surface, which side it begins on is rounding, and the formulas for one crossing and for both may
  // differ.
  const bool begins_there = std::abs(c.value(0)) <= c.bound;
  if (listed.any != hit || (hit == listed.all.empty() && !begins_there))
    note("nearest, any and the list do not agree on whether there is a hit");
  // Of two crossings at one t the list has the leaving one first.
  if (hit && !listed.all.empty()) {
    const auto same = [&](std::size_t i) {
      const HitRecord& other = listed.all[i];
      return listed.nearest.t == other.t && listed.nearest.surface == other.surface && listed.nearest.slot == other.slot;
    };
    if (!begins_there && !same(0) && !(listed.all.size() > 1 && same(1)))
      note(fmt::format("the nearest hit is at {}, the first of the list at {}", listed.nearest.t, listed.all[0].t));
  }
  double worst = 0;
  for (std::size_t i = 0; i < listed.all.size(); ++i) {
    double ratio = 0;
    note(wrong_place(c, listed.all[i], &ratio));
    worst = std::max(worst, ratio);
    if (!(listed.all[i].t > 0) || (i > 0 && !(listed.all[i].t >= listed.all[i - 1].t))) note("the list is not in order");
  }
  bool excused = false;
  if (std::holds_alternative<reference::Csg>(*c.witness)) {
    note(wrong_way(c, listed.all, 2 * c.bound));
  } else {
    std::vector<reference::Crossing> expected;
    for (const reference::Crossing& crossing : reference::crossings(*c.witness, c.ray))
      if (crossing.t > 0) expected.push_back(crossing);
    if (const std::string text = different(c, expected, listed.all); !text.empty()) {
      // Where the ray begins at the surface, which side it begins on is rounding; else the referee has to say that the line
      // touches.
      excused = std::abs(c.value(0)) <= c.bound || c.touches();
      if (!excused) note(text);
    }
  }
  const std::lock_guard lock(tally.mutex);
  ++tally.rays;
  tally.crossings += listed.all.size();
  tally.excused += excused;
  tally.worst = std::max(tally.worst, worst);
  if (!wrong.empty() && ++tally.failures <= 5) ADD_FAILURE() << wrong << "\n" << where;
}

std::string described(const FlatPrimitive& p, const RayRecord& r) {
  std::string out = fmt::format("shape {}:", p.shape);
  for (const float x : p.data) out += fmt::format(" {:a}", x);
  return out + fmt::format("\nray: {:a} {:a} {:a}  {:a} {:a} {:a}", r.ox, r.oy, r.oz, r.dx, r.dy, r.dz);
}

void report(const char* name, const Tally& tally) {
  std::printf("%s: %llu rays, %llu crossings, %llu excused by the referee, %llu failures, worst %.3f of the bound\n", name,
              static_cast<unsigned long long>(tally.rays), static_cast<unsigned long long>(tally.crossings),
              static_cast<unsigned long long>(tally.excused), static_cast<unsigned long long>(tally.failures), tally.worst);
  EXPECT_EQ(tally.failures, 0u);
  EXPECT_GT(tally.crossings, tally.rays / 4);
  EXPECT_LT(tally.excused, tally.rays / 4);
}

class Agreement : public testing::TestWithParam<ShapeKind> {};

TEST_P(Agreement, OfLists) {
  Tally tally;
  for (int part = 0; part < test_scale(); ++part) {
    CaseMaker maker(1000 + static_cast<std::uint32_t>(part));
    const CaseSet cases = maker.set(GetParam().shape, true, 400, 50);
    const auto listed = Probe(device(), 8, cases.primitives, cases.leaves).list(cases.which, cases.rays, capacity);
    tbb::parallel_for(std::size_t{0}, listed.size(), [&](std::size_t i) {
      const RayRecord& ray = cases.rays[i];
      const Case c{&cases.primitive(i), &cases.witness(i), witness_ray(ray),
                   surface_bound(cases.primitive(i), cases.witness(i), ray)};
      check(c, listed[i], described(cases.primitive(i), ray), tally);
    });
  }
  report(GetParam().name, tally);
}

// The kernel's ray in object space is that of the float matrix, rounded.
TEST_P(Agreement, OfListsUnderAffineMaps) {
  Tally tally;
  for (int part = 0; part < test_scale(); ++part) {
    CaseMaker maker(5000 + static_cast<std::uint32_t>(part));
    const PlacedCases placed = placed_cases(maker.set(GetParam().shape, false, 400, 50), 7000 + static_cast<std::uint32_t>(part));
    const CaseSet& cases = placed.cases;
    const auto listed = Probe(device(), 8, placed.placed, cases.leaves).list(cases.which, cases.rays, capacity);
    tbb::parallel_for(std::size_t{0}, listed.size(), [&](std::size_t i) {
      const reference::Ray world = witness_ray(cases.rays[i]);
      const std::array<float, 12>& m = placed.placed[cases.which[i]].object_from_world;
      Case c{&cases.primitive(i), &cases.witness(i), {}, 0};
      dvec3 terms{0}, slopes{0};
      for (int r = 0; r < 3; ++r) {
        const auto row = static_cast<std::size_t>(4 * r);
        c.ray.origin[r] = m[row + 3];
        c.ray.direction[r] = 0;
        terms[r] = std::abs(double(m[row + 3]));
        for (int k = 0; k < 3; ++k) {
          const double entry = m[row + static_cast<std::size_t>(k)];
          c.ray.origin[r] += entry * world.origin[k];
          c.ray.direction[r] += entry * world.direction[k];
          terms[r] += std::abs(entry * world.origin[k]);
          slopes[r] += std::abs(entry * world.direction[k]);
        }
      }
      const RayRecord object_ray = make_ray(c.ray.origin, c.ray.direction);
      const reference::Ball ball = reference::bounding_ball(*c.witness);
      // docs/numerics.md, "Instances": 4 eps of the terms of the origin, and as much of those of t d where the shape is.
      const double t = (glm::length(c.ray.origin - ball.center) + ball.radius) / glm::length(c.ray.direction);
      c.bound = surface_bound(*c.primitive, *c.witness, object_ray) + 4 * eps * (glm::length(terms) + t * glm::length(slopes));
      std::string where = described(*c.primitive, cases.rays[i]) + "\nobject from world:";
      for (const float x : m) where += fmt::format(" {:a}", x);
      check(c, listed[i], where, tally);
    });
  }
  report(GetParam().name, tally);
}

INSTANTIATE_TEST_SUITE_P(Kinds, Agreement, testing::ValuesIn(shape_kinds().begin(), shape_kinds().end()),
                         [](const auto& instance) { return std::string(instance.param.name); });

}  // namespace
}  // namespace caplet::test
