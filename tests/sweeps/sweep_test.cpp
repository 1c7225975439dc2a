// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The sweeps of ./run sweeps with fewer rays: in every cell all hits are within the bound that
// docs/numerics.md states, and no hit or miss differs from the reference but where the referee says
// that the ray touches. CAPLET_TEST_SCALE=N: N times the rays.
#include <gtest/gtest.h>

#include "support/test_device.h"
#include "sweep.h"

namespace caplet::test {
namespace {

class Sweeps : public testing::TestWithParam<ShapeKind> {};

TEST_P(Sweeps, StayWithinTheBound) {
  for (const Axis& axis : axes()) {
    if (!has_axis(GetParam().shape, axis.name)) continue;
    const auto cells =
        sweep(test_device(), GetParam().shape, axis.name, axis.values, 300 * test_scale(), 1);
    double worst = 0;
    std::uint64_t excused = 0;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const Cell& cell = cells[i];
      for (const std::string& example : cell.examples)
        ADD_FAILURE() << axis.title << " " << axis.values[i] << ": " << example;
      EXPECT_EQ(cell.wrong, 0u) << axis.title << " " << axis.values[i];
      EXPECT_LE(cell.bound_worst, 1) << axis.title << " " << axis.values[i];
      EXPECT_LE(cell.differ_bound, 1) << axis.title << " " << axis.values[i];
      EXPECT_GT(cell.hits, cell.rays / 10) << axis.title << " " << axis.values[i];
      worst = std::max(worst, cell.bound_worst);
      excused += cell.excused;
    }
    std::printf("%s: worst %.3f of the bound, %llu excused by the referee\n", axis.title, worst,
                static_cast<unsigned long long>(excused));
  }
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, Sweeps, [] { return testing::ValuesIn(sweep_kinds()); }(),
    [](const auto& instance) { return std::string(instance.param.name); });

}  // namespace
}  // namespace caplet::test
