// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Directions of bsdf_sample against the density of bsdf_eval: Pearson's test over cells of the
// sphere, for each BSDF, roughness and angle; the integrals of density and of f |cos|. The
// statistic itself is tested first.
#include "support/chi_square.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <tuple>

#include "trials.h"

namespace caplet::test {
namespace {

constexpr int rows = 32, columns = 32;
constexpr std::size_t samples = 40000;
constexpr double significance = 0.01;  // of any false alarm in the whole family of tests

// NIST/SEMATECH e-Handbook, table of upper critical values of the chi-square distribution.
TEST(ChiSquare, CriticalValues) {
  EXPECT_NEAR(gamma_q(0.5, 3.841 / 2), 0.05, 2e-5);
  EXPECT_NEAR(gamma_q(5, 18.307 / 2), 0.05, 2e-5);
  EXPECT_NEAR(gamma_q(5, 23.209 / 2), 0.01, 2e-5);
  EXPECT_NEAR(gamma_q(50, 124.342 / 2), 0.05, 2e-5);
  EXPECT_NEAR(gamma_q(1, 3), std::exp(-3.0), 1e-14);
  EXPECT_EQ(gamma_q(3, 0), 1);
  EXPECT_NEAR(sidak(0.05, 10), 0.0051162, 1e-7);
}

TEST(ChiSquare, PoolsSmallCells) {
  const std::vector<double> observed = {1, 2, 3, 20, 30}, expected = {1, 1, 3, 22, 29};
  const ChiSquareResult result = chi_square(observed, expected);
  EXPECT_EQ(result.degrees_of_freedom, 2);
  EXPECT_NEAR(result.statistic, 1.0 / 5 + 4.0 / 22 + 1.0 / 29, 1e-12);
  EXPECT_THROW(chi_square(observed, std::vector<double>{1, 2}), std::invalid_argument);
  EXPECT_THROW(chi_square(std::vector<double>{1}, std::vector<double>{NAN}), std::invalid_argument);
  EXPECT_EQ(chi_square(std::vector<double>{3, 1}, std::vector<double>{0, 0}).p_value, 0);
}

std::size_t cell_of(const Direction& wi) {
  const double theta = std::atan2(std::hypot(double{wi[0]}, double{wi[1]}), double{wi[2]});
  double phi = std::atan2(double{wi[1]}, double{wi[0]});
  if (phi < 0) phi += 2 * std::numbers::pi;
  const int row = std::min(static_cast<int>(theta / std::numbers::pi * rows), rows - 1);
  const int column =
      std::min(static_cast<int>(phi / (2 * std::numbers::pi) * columns), columns - 1);
  return static_cast<std::size_t>(row * columns + column);
}

/// Integrals of density and value over the cells, with steps that resolve the lobe.
std::vector<float> integrate(const BsdfTrial& trial, const BsdfParameters& bsdf,
                             const Direction& wo) {
  static std::map<std::tuple<uint, uint, std::vector<float>, float>, std::vector<float>> known;
  std::vector<float>& integrals = known[{bsdf.kind, bsdf.flags, bsdf.values(), wo[2]}];
  if (integrals.empty())
    integrals =
        bsdf_on_device().integrate(bsdf, wo, rows, columns, trial.steps(bsdf, double{wo[2]}));
  return integrals;
}

/// The test of `observed_by` samples against the density of `expected_by`.
ChiSquareResult compare(const BsdfTrial& trial, const BsdfParameters& observed_by,
                        const BsdfParameters& expected_by, const Direction& wo) {
  std::vector<double> observed(rows * columns + 1, 0.0), expected;
  for (const SampleRow& row :
       bsdf_on_device().sample(observed_by, wo, random_numbers(3 * samples, 17)))
    ++observed[row.scattered > 0 ? cell_of(row.wi) : observed.size() - 1];
  const std::vector<float> integrals = integrate(trial, expected_by, wo);
  double total = 0;
  for (std::size_t i = 0; i < rows * columns; ++i) {
    expected.push_back(static_cast<double>(samples) * double{integrals[i]});
    total += integrals[i];
  }
  expected.push_back(static_cast<double>(samples) *
                     std::max(0.0, 1 - total));  // absorbed: sampled into the wrong hemisphere
  return chi_square(observed, expected);
}

struct Case {
  const BsdfTrial* trial;
  BsdfParameters bsdf;
  double theta;  // of wo
};

/// Returns the cases of every material of the list.
std::vector<Case> all_cases() {
  std::vector<Case> cases;
  for (const MaterialOnTrial& material : materials_on_trial())
    for (const BsdfTrial::Case& one : material.trial.cases)
      for (const double theta : one.thetas) cases.push_back({&material.trial, one.bsdf, theta});
  return cases;
}

TEST(BsdfChiSquare, DirectionsFollowTheDensity) {
  std::vector<Case> cases = all_cases();
  std::erase_if(cases, [](const Case& one) { return one.trial->estimates; });
  const double threshold = sidak(significance, static_cast<int>(cases.size()));
  for (const Case& test : cases) {
    const ChiSquareResult result =
        compare(*test.trial, test.bsdf, test.bsdf, direction(test.theta, 0.6));
    EXPECT_GT(result.p_value, threshold)
        << test.bsdf.name << " at " << test.theta << ": " << result.statistic << " with "
        << result.degrees_of_freedom << " degrees of freedom";
    EXPECT_GT(result.degrees_of_freedom, 3) << test.bsdf.name << " at " << test.theta;
  }
}

// Densities that are wrong by little are found: another roughness, the axes exchanged, another
// index, the cosine against uniform.
TEST(BsdfChiSquare, WrongDensitiesAreFound) {
  const Direction wo = direction(0.7, 0.6);
  for (const MaterialOnTrial& material : materials_on_trial())
    for (const auto& [one, other] : material.trial.unlike)
      EXPECT_LT(compare(material.trial, one, other, wo).p_value, 1e-6)
          << one.name << " and " << other.name;

  const std::vector<float> u = random_numbers(2 * samples, 5);
  std::vector<double> observed(rows * columns, 0.0), expected(rows * columns);
  for (std::size_t i = 0; i < samples; ++i)
    ++observed[cell_of(
        direction(std::acos(double{u[2 * i]}), 2 * std::numbers::pi * double{u[2 * i + 1]}))];
  const std::vector<float> cosine =
      bsdf_on_device().integrate({"", material_diffuse}, {0, 0, 1}, rows, columns, 16);
  for (std::size_t i = 0; i < expected.size(); ++i)
    expected[i] = static_cast<double>(samples) * double{cosine[i]};
  EXPECT_LT(chi_square(observed, expected).p_value, 1e-6);
}

// The white furnace: no BSDF sends back more than it gets, and densities integrate to at most one.
// 2e-3 is allowed for the midpoint rule. What a rough surface's density lacks is sampled below the
// horizon and absorbed.
TEST(BsdfIntegrals, AtMostOne) {
  for (const Case& test : all_cases()) {
    const std::vector<float> integrals =
        integrate(*test.trial, test.bsdf, direction(test.theta, 0.6));
    const auto middle = integrals.begin() + rows * columns;
    const double density = std::accumulate(integrals.begin(), middle, 0.0),
                 albedo = std::accumulate(middle, integrals.end(), 0.0);
    const double tolerance = 2e-3;
    const double most = test.trial->most(test.bsdf, test.theta > 1.6);
    EXPECT_LE(density, 1 + tolerance) << test.bsdf.name << " at " << test.theta;
    EXPECT_LE(albedo, most * (1 + tolerance)) << test.bsdf.name << " at " << test.theta;
    EXPECT_GT(density, test.trial->estimates ? 0.1 : 0.5) << test.bsdf.name << " at " << test.theta;
    if (test.bsdf.kind == material_diffuse) {
      EXPECT_NEAR(density, 1, tolerance);
      EXPECT_NEAR(albedo, double{test.bsdf.reflectance}, tolerance);
    }
  }
}

}  // namespace
}  // namespace caplet::test
