// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Materials that are the same along u and v do not tell directions around the normal apart.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "trials.h"

namespace caplet::test {
namespace {

// Both directions turned together about the normal: values and densities stay. Half vectors are
// rounded anew: densities by some 8 * 2e-7 / alpha, near grazing by more.
TEST(BsdfRotations, LeaveValuesAndDensities) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> unit(0, 1);
  std::size_t tried = 0;
  for (const MaterialOnTrial& material : materials_on_trial()) {
    if (material.trial.estimates) continue;
    for (const BsdfTrial::Case& one : material.trial.cases) {
      const BsdfParameters& bsdf = one.bsdf;
      // Fibres are not the same along u and v.
      if (bsdf.alpha_u != bsdf.alpha_v || bsdf.kind == material_hair) continue;
      std::vector<Direction> wo, wi, wo_turned, wi_turned;
      for (int i = 0; i < 400; ++i) {
        const double a = std::acos(1 - 2 * unit(random)), b = std::acos(1 - 2 * unit(random));
        const double phi = 6.28 * unit(random), psi = 6.28 * unit(random),
                     turn = 6.28 * unit(random);
        wo.push_back(direction(a, phi));
        wi.push_back(direction(b, psi));
        wo_turned.push_back(direction(a, phi + turn));
        wi_turned.push_back(direction(b, psi + turn));
      }
      const auto before = bsdf_on_device().evaluate(bsdf, wo, wi),
                 after = bsdf_on_device().evaluate(bsdf, wo_turned, wi_turned);
      for (std::size_t i = 0; i < wo.size(); ++i) {
        EXPECT_NEAR(after[i].value, before[i].value, 3e-3 * std::abs(before[i].value) + 1e-6)
            << bsdf.name << " " << i;
        EXPECT_NEAR(after[i].pdf, before[i].pdf, 3e-3 * before[i].pdf + 1e-6)
            << bsdf.name << " " << i;
      }
      ++tried;
    }
  }
  EXPECT_GT(tried, 10U);
}

}  // namespace
}  // namespace caplet::test
