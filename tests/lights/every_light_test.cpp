// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// What all lights have in common, over the list (kernels/shared/lights.def): samples that are
// sound, and the irradiance of a closed form.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <set>
#include <string>
#include <variant>

#include "light_bench.h"
#include "light_scenes.h"
#include "light_trials.h"
#include "support/kinds.h"

namespace caplet::test::every_light_test {

namespace {

LightTrial trial_of(const Kind& kind) {
#define LIGHT(name, ...) \
  if (kind.number == light_##name) return name##_trial();
#include "shared/lights.def"
#undef LIGHT
  throw std::logic_error("no light of that number");
}

/// Radiance that white of an image has at the first wavelength of the bench.
double white_radiance() {
  return LightBench(lower(scene_with({image_light(2, 1, false, std::vector<float>(6, 1.f))})))
      .sky({{0, 0, 1}})[0]
      .x;
}

class EveryLight : public testing::TestWithParam<Kind> {};

}  // namespace

TEST_P(EveryLight, SamplesAreSoundAndGiveItsIrradiance) {
  const LightTrial trial = trial_of(GetParam());
  const FlatScene flat = lower(trial.scene);
  ASSERT_EQ(flat.lights.size(), 1u);
  EXPECT_EQ(flat.lights[0].kind, static_cast<uint>(GetParam().number));
  EXPECT_EQ(flat.lighting.sampled_light_count, trial.is_sampled ? 1u : 0u);
  LightBench bench(flat);
  constexpr std::size_t count = 100000;
  double mean = 0, squares = 0;
  if (trial.is_sampled) {
    const std::vector<SampledLight> samples = bench.sample(trial.p, count);
    for (const SampledLight& s : samples) {
      ASSERT_TRUE(std::isfinite(s.pdf) && s.pdf > 0);
      ASSERT_TRUE(std::isfinite(s.radiance) && s.radiance >= 0);
      ASSERT_NEAR(glm::length(s.wi), 1, 1e-6);
      ASSERT_EQ(s.delta, trial.is_delta);
      ASSERT_EQ(s.infinite, trial.is_infinite);
      ASSERT_FALSE(s.occluded);
      const double x = s.radiance * std::max(0.0, glm::dot(s.wi, trial.n)) / s.pdf;
      mean += x / count;
      squares += x * x / count;
    }
    if (trial.is_infinite && !trial.is_delta) {
      // A ray that finds the sky where a sample lies has the sample's radiance and density: the
      // density by the weight of rays, which has 1e-7 / (1 - weight), and of texels' borders either
      // one.
      std::vector<glm::dvec3> directions;
      for (std::size_t i = 0; i < 1000; ++i) directions.push_back(samples[i].wi);
      const std::vector<glm::dvec2> sky = bench.sky(directions, trial.p);
      int apart = 0;
      for (std::size_t i = 0; i < directions.size(); ++i) {
        EXPECT_NEAR(sky[i].x, samples[i].radiance, 1e-3 * samples[i].radiance + 1e-5);
        apart +=
            samples[i].pdf > 0.02 && std::abs(sky[i].y - samples[i].pdf) > 3e-3 * samples[i].pdf;
      }
      EXPECT_LE(apart, 3);
    }
  } else {
    EXPECT_EQ(bench.sample(trial.p, 1)[0].pdf, 0);
    const std::vector<glm::dvec3> directions = sphere_directions(count);
    const std::vector<glm::dvec2> sky = bench.sky(directions);
    for (std::size_t i = 0; i < count; ++i) {
      const double x =
          sky[i].x * std::max(0.0, glm::dot(directions[i], trial.n)) * 4 * 3.141592653589793;
      mean += x / count;
      squares += x * x / count;
    }
  }
  const double expected = trial.irradiance * (trial.per_white ? white_radiance() : 1);
  const double error = std::sqrt(std::max(0.0, squares - mean * mean) / count);
  // Four standard errors; the closed forms' own 1e-3 of images; some ten roundings of floats. A
  // delta light has no error but these.
  EXPECT_NEAR(mean, expected, 4 * error + (trial.per_white ? 1e-3 : 2e-6) * expected);
}

// What a renderer builds for a scene of this light alone gives what the kernels of all lights give,
// and what is built for all others has nothing of it.
TEST_P(EveryLight, KernelsOfItAloneSayTheSameAndThoseOfAllOthersNothing) {
  const LightTrial trial = trial_of(GetParam());
  const FlatScene flat = lower(trial.scene);
  const std::uint64_t own = std::uint64_t{1} << GetParam().number;
  ASSERT_EQ(flat.light_kinds(), own);
  LightBench all(flat), alone(flat, {{"lights", own}, {"shapes", flat.shapes}}),
      others(flat, {{"lights", ~own}});
  const std::vector<SampledLight> expected = all.sample(trial.p, 1000),
                                  seen = alone.sample(trial.p, 1000),
                                  none = others.sample(trial.p, 1000);
  for (std::size_t i = 0; i < expected.size(); ++i) {
    ASSERT_EQ(seen[i].pdf, expected[i].pdf);
    ASSERT_EQ(seen[i].radiance, expected[i].radiance);
    ASSERT_EQ(seen[i].wi, expected[i].wi);
    ASSERT_EQ(seen[i].target, expected[i].target);
    ASSERT_EQ(none[i].pdf, 0);
  }
  EXPECT_EQ(expected[0].pdf > 0, trial.is_sampled);
  const std::vector<glm::dvec3> directions = sphere_directions(1000);
  const std::vector<glm::dvec2> sky = all.sky(directions, trial.p),
                                own_sky = alone.sky(directions, trial.p),
                                no_sky = others.sky(directions, trial.p);
  for (std::size_t i = 0; i < directions.size(); ++i) {
    ASSERT_EQ(own_sky[i].x, sky[i].x);
    ASSERT_EQ(no_sky[i].x, 0);
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, EveryLight, testing::ValuesIn(all_lights), name_of_kind);

// A light of the model that is no row of the list would be on no trial.
TEST(LightTrials, EveryLightOfTheModelIsOnTrial) {
  std::set<std::size_t> models;
  for (const Kind& kind : all_lights)
    for (const Light& light : trial_of(kind).scene.lights) models.insert(light.model.index());
  EXPECT_EQ(models.size(), std::variant_size_v<decltype(Light::model)>);
}

}  // namespace caplet::test::every_light_test
