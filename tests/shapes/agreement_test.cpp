// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Nearest hit, any hit and the full hit list of every kind of shape against the reference, by
// themselves and under random affine maps, ray by ray. 20,000 rays a test; CAPLET_TEST_SCALE=50
// makes it a million.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <mutex>

#include "judge.h"
#include "support/test_device.h"

namespace caplet::test {
namespace {

constexpr std::uint32_t capacity = 24;

struct Tally {
  std::mutex mutex;
  std::uint64_t rays = 0, crossings = 0, excused = 0, failures = 0;
  double worst = 0;
};

void check(const Case& c, const Listed& listed, const std::string& where, Tally& tally) {
  const Judgement judgement = judge(c, listed, capacity);
  const std::lock_guard lock(tally.mutex);
  ++tally.rays;
  tally.crossings += listed.all.size();
  tally.excused += judgement.excused;
  tally.worst = std::max(tally.worst, judgement.worst);
  if (!judgement.wrong.empty() && ++tally.failures <= 5)
    ADD_FAILURE() << judgement.wrong << "\n" << where;
}

void report(const char* name, const Tally& tally) {
  std::printf(
      "%s: %llu rays, %llu crossings, %llu excused by the referee, %llu failures, worst %.3f of "
      "the bound\n",
      name, static_cast<unsigned long long>(tally.rays),
      static_cast<unsigned long long>(tally.crossings),
      static_cast<unsigned long long>(tally.excused),
      static_cast<unsigned long long>(tally.failures), tally.worst);
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
    const auto listed = Probe(test_device(), test_width(), cases.primitives, cases.leaves)
                            .list(cases.which, cases.rays, capacity);
    tbb::parallel_for(std::size_t{0}, listed.size(), [&](std::size_t i) {
      const RayRecord& ray = cases.rays[i];
      check(make_case(cases.primitive(i), cases.reference(i), ray), listed[i],
            described(cases.primitive(i), ray), tally);
    });
  }
  report(GetParam().name, tally);
}

TEST_P(Agreement, OfListsUnderAffineMaps) {
  Tally tally;
  for (int part = 0; part < test_scale(); ++part) {
    CaseMaker maker(5000 + static_cast<std::uint32_t>(part));
    const PlacedCases placed = placed_cases(maker.set(GetParam().shape, false, 400, 50),
                                            7000 + static_cast<std::uint32_t>(part));
    const CaseSet& cases = placed.cases;
    const auto listed = Probe(test_device(), test_width(), placed.placed, cases.leaves)
                            .list(cases.which, cases.rays, capacity);
    tbb::parallel_for(std::size_t{0}, listed.size(), [&](std::size_t i) {
      const PlacedPrimitive& primitive = placed.placed[cases.which[i]];
      std::string where = described(primitive.primitive, cases.rays[i]) + "\nobject from world:";
      for (const float x : primitive.object_from_world) where += fmt::format(" {:a}", x);
      check(make_case(primitive, cases.reference(i), cases.rays[i]), listed[i], where, tally);
    });
  }
  report(GetParam().name, tally);
}

INSTANTIATE_TEST_SUITE_P(Kinds, Agreement,
                         testing::ValuesIn(shape_kinds().begin(), shape_kinds().end()),
                         [](const auto& instance) { return std::string(instance.param.name); });

}  // namespace
}  // namespace caplet::test
