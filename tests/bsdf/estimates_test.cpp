// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Materials whose values are estimates: their means against closed forms; the weights of samples
// against the values over cells of the sphere; reciprocity; what a white one gives back; the same
// numbers for the same key.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "coats.h"
#include "support/thorough.h"
#include "trials.h"

namespace caplet::test::estimates_test {
namespace {

struct Mean {
  double value = 0, error = 0;  // of the mean: one standard deviation
};

Mean mean_of(const std::vector<double>& values) {
  const auto n = static_cast<double>(values.size());
  double sum = 0, squares = 0;
  for (const double v : values) sum += v, squares += v * v;
  return {sum / n, std::sqrt(std::max(0.0, squares / n - sum * sum / (n * n)) / (n - 1))};
}

Mean mean_value(const BsdfParameters& bsdf, const Direction& wo, const Direction& wi,
                std::size_t count) {
  const std::vector<Direction> all_wo(count, wo), all_wi(count, wi);
  std::vector<double> values;
  for (const EvalRow& row : bsdf_on_device().evaluate(bsdf, all_wo, all_wi))
    values.push_back(double{row.value});
  return mean_of(values);
}

template <class Visit>
void each_estimate(Visit visit) {
  for (const MaterialOnTrial& material : materials_on_trial())
    if (material.trial.estimates)
      for (const BsdfTrial::Case& one : material.trial.cases)
        for (const double theta : one.thetas) visit(material.trial, one.bsdf, theta);
}

// Five standard deviations of the mean, and rounding: 6e-7 of false alarm each.
TEST(BsdfEstimates, MeansAreClosedForms) {
  for (const MaterialOnTrial& material : materials_on_trial())
    for (const KnownValue& known : material.trial.values) {
      if (!material.trial.estimates) continue;
      const Mean seen = mean_value(known.bsdf, known.wo, known.wi, 100000);
      EXPECT_NEAR(seen.value, known.value, 5 * seen.error + known.tolerance * known.value)
          << known.bsdf.name;
      EXPECT_LT(seen.error, 0.01 * known.value) << known.bsdf.name;
    }
}

constexpr int rows = 32, columns = 32, coarse = 8;

// What samples weigh in each of 8 x 8 cells of the sphere is the integral of the values over it: 60
// cells of a case, six deviations each, to which the noise of the integral is added, of eight
// repetitions. What is delta is in no value.
TEST(BsdfEstimates, WeightsAreOfTheValues) {
  constexpr std::size_t count = 100000, repetitions = 8;
  BsdfOnDevice device;
  each_estimate([&](const BsdfTrial& trial, const BsdfParameters& bsdf, double theta) {
    const Direction wo = direction(theta, 0.6);
    std::vector<double> sums(coarse * coarse, 0.0), squares(coarse * coarse, 0.0);
    const auto cell = [](int row, int column) {
      return static_cast<std::size_t>(row * coarse / rows * coarse + column * coarse / columns);
    };
    device.key = 99;
    for (const SampleRow& row : device.sample(bsdf, wo, random_numbers(3 * count, 21))) {
      if (row.scattered == 0 || row.specular != 0) continue;
      const double polar = std::acos(std::clamp(double{row.wi[2]}, -1.0, 1.0));
      double azimuth = std::atan2(double{row.wi[1]}, double{row.wi[0]});
      if (azimuth < 0) azimuth += 2 * std::numbers::pi;
      const std::size_t at =
          cell(std::min(rows - 1, static_cast<int>(polar / std::numbers::pi * rows)),
               std::min(columns - 1, static_cast<int>(azimuth / (2 * std::numbers::pi) * columns)));
      sums[at] += double{row.weight};
      squares[at] += double{row.weight} * double{row.weight};
    }
    std::vector<std::vector<double>> integrals(coarse * coarse);
    const int steps = std::max(4, trial.steps(bsdf, double{wo[2]}) / 3);
    for (uint repetition = 0; repetition < repetitions; ++repetition) {
      device.key = repetition;
      const std::vector<float> fine = device.integrate(bsdf, wo, rows, columns, steps);
      std::vector<double> cells(coarse * coarse, 0.0);
      for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column)
          cells[cell(row, column)] +=
              double{fine[static_cast<std::size_t>(rows * columns + row * columns + column)]};
      for (std::size_t i = 0; i < cells.size(); ++i) integrals[i].push_back(cells[i]);
    }
    double total_seen = 0, total = 0, total_variance = 0;
    for (std::size_t i = 0; i < sums.size(); ++i) {
      const Mean expected = mean_of(integrals[i]);
      const double n = static_cast<double>(count), seen = sums[i] / n;
      const double variance = (squares[i] / n - seen * seen) / n + expected.error * expected.error;
      EXPECT_NEAR(seen, expected.value, 6 * std::sqrt(variance) + 3e-3 * expected.value + 2e-5)
          << bsdf.name << " at " << theta << ", cell " << i;
      total_seen += seen;
      total += expected.value;
      total_variance += variance;
    }
    EXPECT_NEAR(total_seen, total, 5 * std::sqrt(total_variance) + 2e-3 * total)
        << bsdf.name << " at " << theta;
    EXPECT_GT(total, 0.02) << bsdf.name;
  });
}

TEST(BsdfEstimates, AreReciprocal) {
  const std::size_t count = thorough() ? 200000 : 100000;
  for (const MaterialOnTrial& material : materials_on_trial())
    if (material.trial.estimates)
      for (const BsdfTrial::Case& one : material.trial.cases)
        for (const auto& [o, i] : {std::pair(0.3, 1.1), std::pair(1.3, 0.7)}) {
          const Direction wo = direction(o, 0.3), wi = direction(i, 2.9);
          const Mean forward = mean_value(one.bsdf, wo, wi, count),
                     backward = mean_value(one.bsdf, wi, wo, count);
          const double cos_i = double{wi[2]}, cos_o = double{wo[2]};
          EXPECT_NEAR(forward.value / cos_i, backward.value / cos_o,
                      5 * std::hypot(forward.error / cos_i, backward.error / cos_o) +
                          2e-3 * forward.value / cos_i)
              << one.bsdf.name;
        }
}

// White under a clear interface of no thickness: all comes back, after as many turns as it takes.
TEST(BsdfEstimates, AWhiteBaseUnderAClearCoatGivesAllBack) {
  BsdfParameters white = coat("white", material_coateddiffuse, 0);
  white.thickness = 1e-30f;
  white.max_depth = 10000;
  BsdfParameters fog = white;
  fog.thickness = 2;
  fog.albedo = 1;
  fog.g = 0.6f;
  for (const BsdfParameters& one : {white, fog})
    for (const double theta : {0.1, 1.2, 2.3})
      for (const SampleRow& row :
           bsdf_on_device().sample(one, direction(theta, 1), random_numbers(3000, 5))) {
        ASSERT_EQ(row.scattered, 1) << theta;
        ASSERT_NEAR(row.weight, 1, 1e-5) << theta;
      }
}

// What is lost: by 10 events at the most, and by an absorbing layer.
TEST(BsdfEstimates, StatedLosses) {
  const auto kept = [](const BsdfParameters& bsdf) {
    std::vector<double> weights;
    for (const SampleRow& row :
         bsdf_on_device().sample(bsdf, direction(0.4, 1), random_numbers(300000, 5)))
      weights.push_back(double{row.weight});
    return mean_of(weights);
  };
  // A walk of 10 events meets the base 5 times: of what entered, R^5 is still on its way.
  BsdfParameters white = coat("white", material_coateddiffuse, 0);
  white.thickness = 1e-30f;
  white.max_depth = 10;
  const double in = 1 - fresnel(std::cos(0.4), 1.5),
               lost = in * std::pow(internal_reflectance(1.5), 5);
  const Mean seen = kept(white);
  EXPECT_NEAR(seen.value, 1 - lost, 5 * seen.error + 1e-5);
  // Mirror under glass: F + T^2 a (1 + F a + ...), where a is what passes both ways.
  BsdfParameters mirror = coat("mirror", material_coatedconductor, 0);
  mirror.eta = 0;
  mirror.k = 1e4f;
  mirror.thickness = 0.3f;
  mirror.max_depth = 100;
  const double f = 1 - in, cos_t = std::sqrt(1 - std::pow(std::sin(0.4) / 1.5, 2)),
               a = std::exp(-2 * double{0.3f} / cos_t);
  const Mean reflected = kept(mirror);
  EXPECT_NEAR(reflected.value, f + in * in * a / (1 - f * a), 5 * reflected.error + 1e-3);
}

TEST(BsdfEstimates, AreTheSameForTheSameKey) {
  const BsdfParameters rough = [] {
    BsdfParameters out = coat("rough", material_coateddiffuse, 0.3f);
    out.albedo = 0.5f;
    return out;
  }();
  BsdfOnDevice device;
  const std::vector<Direction> wo(100, direction(0.5, 1)), wi(100, direction(0.9, 3));
  const auto values = [&](uint key) {
    device.key = key;
    std::vector<float> out;
    for (const EvalRow& row : device.evaluate(rough, wo, wi)) out.push_back(row.value);
    return out;
  };
  EXPECT_EQ(values(1), values(1));
  EXPECT_NE(values(1), values(2));
}

}  // namespace
}  // namespace caplet::test::estimates_test
