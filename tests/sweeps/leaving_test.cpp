// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Paths that leave surfaces of every kind, at every value of the sweeps: from the computed surface
// point, moved by offset_origin to either side, in directions of the hemisphere down to 1e-6 from
// the tangent plane. Nothing is met again that is not there, and from within a solid its other side
// is met. Some 20,000 paths a kind; CAPLET_TEST_SCALE=50 makes it a million and more.
#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <mutex>

#include "shared/kinds.h"
#include "support/test_device.h"
#include "sweep.h"

namespace caplet::test {
namespace {

using glm::dvec3;

constexpr std::uint32_t capacity = 24;

dvec3 point(const float* p) { return {p[0], p[1], p[2]}; }

enum class Side { outward, inward };

// What the geometry lets a path meet that leaves the true surface.
enum class Expected {
  nothing,   // a convex solid or a part of its boundary from outside; a plane from either side
  one_exit,  // a convex solid from inside
  reference  // whatever the reference says
};
Expected expected_of(int shape, const reference::Primitive& reference, Side side) {
  if (shape == shape_triangle || shape == shape_disk || shape == shape_partial_disk)
    return Expected::nothing;
  if (shape == shape_csg || shape == shape_bilinear || shape == shape_molecular_patch)
    return Expected::reference;
  if (side == Side::outward) return Expected::nothing;
  return reference::is_solid(reference) ? Expected::one_exit : Expected::reference;
}

struct Tally {
  std::mutex mutex;
  std::uint64_t paths = 0, again = 0, lost = 0, different = 0;
  std::uint64_t thin = 0;  // begin at an edge, where the solid is thinner than `error`; or the
                           // referee says that they touch
  int shown = 0;
};

struct Path {
  std::uint32_t which;
  Side side;
  Probed from;
  std::array<float, 3> direction;
};

std::array<float, 3> direction_over(const dvec3& n, CaseMaker& maker) {
  for (;;) {
    const dvec3 around = maker.direction(),
                across = glm::normalize(around - glm::dot(around, n) * n);
    const double height = std::pow(10.0, maker.uniform(-6, 0));
    const dvec3 d = std::sqrt(1 - height * height) * across + height * n;
    const std::array<float, 3> out{static_cast<float>(d.x), static_cast<float>(d.y),
                                   static_cast<float>(d.z)};
    if (glm::dot(point(out.data()), n) >= 1e-7)
      return out;  // rounding must not turn it to the other side
  }
}

// Returns the stretch of object_from_world along the normal: a world distance times this is one in
// object space.
double stretch_of(const PlacedPrimitive& placed, const Probed& from) {
  dvec3 n = point(from.surface.ng), out(0);
  for (int r = 0; r < 3; ++r)
    for (int k = 0; k < 3; ++k)
      out[k] += double(placed.world_from_object[static_cast<std::size_t>(4 * r + k)]) * n[r];
  return 1 / glm::length(out);
}

void check(const SweepCases& all, const Path& path, const Listed& listed, const RayRecord& ray,
           Tally& tally) {
  const reference::Primitive& reference = all.cases.references[path.which];
  const PlacedPrimitive& placed = all.placed[path.which];
  const auto shape = static_cast<int>(placed.primitive.shape);
  const Expected expected = expected_of(shape, reference, path.side);
  // In the primitive's space.
  const double error =
      double(path.from.surface.error) * (placed.placed ? stretch_of(placed, path.from) : 1.0);
  const bool hit = listed.nearest.slot != CAPLET_NONE;
  bool again = false, lost = false, different = false, thin = false;
  if (expected == Expected::nothing) {
    again = hit || listed.any || listed.count > 0;
  } else {
    const Case c = placed.placed ? make_case(placed, reference, ray)
                                 : make_case(placed.primitive, reference, ray);
    if (expected == Expected::reference) {
      const Judgement judgement = judge(c, listed, capacity);
      different = !judgement.wrong.empty();
      thin = judgement.excused;
    } else {
      different = !wrong_way(c, listed.all, c.bound).empty();
      // Next to an edge or an apex `error` may lead through the solid, or along another surface:
      // then it is not half of it deep.
      const bool deep = c.value(0) < -0.5 * error;
      const bool one_exit =
          hit && (listed.nearest.surface & CAPLET_LEAVING) != 0 && listed.count == 1;
      lost = deep && !one_exit;
      thin = !deep;
    }
  }
  const std::lock_guard lock(tally.mutex);
  ++tally.paths;
  tally.again += again;
  tally.lost += lost;
  tally.different += different;
  tally.thin += thin;
  if ((again || lost || different) && ++tally.shown <= 5) {
    const SurfaceOut& s = path.from.surface;
    ADD_FAILURE() << (again  ? "met again"
                      : lost ? "no exit"
                             : "not what the reference says")
                  << " at " << listed.nearest.t << ", " << listed.count << " crossings, "
                  << (path.side == Side::outward ? "outward" : "inward") << "; error " << s.error
                  << " surface " << s.surface << "\n"
                  << described(placed.primitive, ray);
  }
}

// Traces all rays, leaves every surface that they meet to either side, and traces on.
void leave_all(const SweepCases& all, std::uint32_t seed, Tally& tally) {
  const Probe probe(test_device(), test_width(), all.placed, all.cases.leaves);
  const auto probed = probe.trace(all.cases.which, all.cases.rays);
  CaseMaker maker(seed);
  std::vector<Side> sides;
  std::vector<std::uint32_t> which;
  std::vector<Probed> from;
  std::vector<std::array<float, 3>> directions;
  for (std::size_t i = 0; i < probed.size(); ++i) {
    if (probed[i].hit.slot == CAPLET_NONE) continue;
    for (const Side side : {Side::outward, Side::inward}) {
      sides.push_back(side);
      which.push_back(all.cases.which[i]);
      from.push_back(probed[i]);
      directions.push_back(direction_over(
          (side == Side::outward ? 1.0 : -1.0) * point(probed[i].surface.ng), maker));
    }
  }
  const auto left = probe.leave(which, from, directions);
  std::vector<RayRecord> rays;
  for (std::size_t i = 0; i < left.size(); ++i)
    rays.push_back(make_ray(point(left[i].origin), point(directions[i].data())));
  const auto listed = probe.list(which, rays, capacity);
  for (std::size_t i = 0; i < left.size(); ++i) ASSERT_EQ(left[i].hit.t, listed[i].nearest.t) << i;
  tbb::parallel_for(std::size_t{0}, rays.size(), [&](std::size_t i) {
    check(all, {which[i], sides[i], from[i], directions[i]}, listed[i], rays[i], tally);
  });
}

void report(const char* name, const Tally& tally) {
  const auto number = [](std::uint64_t x) { return static_cast<unsigned long long>(x); };
  std::printf(
      "%s: %llu paths, %llu meet their surface again, %llu find no exit, %llu differ otherwise; "
      "%llu begin at edges or touch\n",
      name, number(tally.paths), number(tally.again), number(tally.lost), number(tally.different),
      number(tally.thin));
  EXPECT_EQ(tally.again, 0u);
  EXPECT_EQ(tally.lost, 0u);
  EXPECT_EQ(tally.different, 0u);
  EXPECT_LT(tally.thin, tally.paths / 4);
}

class Leaving : public testing::TestWithParam<ShapeKind> {};

TEST_P(Leaving, MeetsNothingAgain) {
  Tally tally;
  for (int part = 0; part < test_scale(); ++part)
    for (const Axis& axis : axes()) {
      if (!has_axis(GetParam().shape, axis.name)) continue;
      const auto seed = 20'000 + 5'000 * static_cast<std::uint32_t>(part);
      leave_all(sweep_cases(GetParam().shape, axis.name, axis.values, 450, seed), seed, tally);
    }
  report(GetParam().name, tally);
  EXPECT_GT(tally.paths, 15'000u);
}

TEST_P(Leaving, MeetsNothingAgainUnderAffineMaps) {
  if (GetParam().shape == shape_instance) GTEST_SKIP() << "one is what the other test has";
  Tally tally;
  for (int part = 0; part < test_scale(); ++part) {
    const auto seed = 30'000 + 2 * static_cast<std::uint32_t>(part);
    CaseMaker maker(seed);
    PlacedCases placed = placed_cases(maker.set(GetParam().shape, false, 200, 60), seed + 1);
    const SweepCases all{std::move(placed.cases), std::move(placed.placed), {}, {}, {}};
    leave_all(all, seed, tally);
  }
  report(GetParam().name, tally);
  EXPECT_GT(tally.paths, 5'000u);
}

const std::vector<ShapeKind> kinds = sweep_kinds();
INSTANTIATE_TEST_SUITE_P(Kinds, Leaving, testing::ValuesIn(kinds),
                         [](const auto& instance) { return std::string(instance.param.name); });

}  // namespace
}  // namespace caplet::test
