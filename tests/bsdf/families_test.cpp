// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Kernels for some materials of the list alone, and the data of a material by the names of its
// fields.
#include <gtest/gtest.h>

#include <bit>
#include <stdexcept>

#include "lower/detail/family_data.h"
#include "lower/lower.h"
#include "trials.h"

namespace caplet::test {
namespace {

// What a renderer builds for a scene of one material says what the kernels of all materials say,
// and what is built for all others knows nothing of it.
TEST(BsdfKernels, OfOneMaterialSayTheSameAndThoseOfAllOthersNothing) {
  const std::vector<float> u = random_numbers(3000, 5);
  for (const MaterialOnTrial& material : materials_on_trial()) {
    const std::uint64_t own = std::uint64_t{1} << material.kind;
    const BsdfOnDevice alone({{"materials", own}}), others({{"materials", ~own}});
    for (const BsdfTrial::Case& one : material.trial.cases) {
      const Direction wo = direction(one.thetas[0], 1);
      const std::vector<SampleRow> expected = bsdf_on_device().sample(one.bsdf, wo, u),
                                   seen = alone.sample(one.bsdf, wo, u);
      int scattered = 0;
      for (std::size_t i = 0; i < expected.size(); ++i) {
        scattered += expected[i].scattered != 0;
        ASSERT_EQ(seen[i].scattered, expected[i].scattered) << one.bsdf.name;
        ASSERT_EQ(seen[i].wi, expected[i].wi) << one.bsdf.name;
        ASSERT_EQ(seen[i].weight, expected[i].weight) << one.bsdf.name;
        ASSERT_EQ(seen[i].value, expected[i].value) << one.bsdf.name;
        ASSERT_EQ(seen[i].value_pdf, expected[i].value_pdf) << one.bsdf.name;
      }
      EXPECT_GT(scattered, 100);
      for (const SampleRow& row : others.sample(one.bsdf, wo, u))
        ASSERT_EQ(row.scattered, 0) << one.bsdf.name;
    }
  }
}

TEST(BsdfKernels, AreForTheMaterialsOfTheScene) {
  Scene scene;
  scene.shapes.emplace_back().geometry = SphereShape{1};
  std::uint64_t kinds = 0;
  for (const MaterialOnTrial& material : materials_on_trial()) {
    scene.materials.push_back(material.trial.model);
    kinds |= std::uint64_t{1} << material.kind;
    EXPECT_EQ(lower(scene).material_kinds(), kinds);
  }
}

// materials.def: reflectance; eta, k, alpha_u, alpha_v; eta, alpha_u, alpha_v.
TEST(MaterialData, LieWhereTheirFieldsAre) {
  ConductorMaterial metal{ConstantSpectrum{0.25}, ConstantSpectrum{4}, std::nullopt, 0.5, 0.125};
  DielectricMaterial glass{ConstantSpectrum{1.75}, 0.0625, 0.5};
  Scene scene;
  scene.shapes.emplace_back().geometry = SphereShape{1};
  scene.materials.emplace_back().model = DiffuseMaterial{ConstantSpectrum{0.75}};
  scene.materials.emplace_back().model = metal;
  scene.materials.emplace_back().model = glass;
  const FlatScene flat = lower(scene);
  const auto value = [&](std::size_t material, std::size_t at) {
    return flat.material_data.at(flat.materials.at(material).data + at);
  };
  const auto spectrum = [&](std::size_t material, std::size_t at) {
    return flat.spectra.at(std::bit_cast<std::uint32_t>(value(material, at))).scale;
  };
  EXPECT_EQ(spectrum(0, 0), 0.75f);
  EXPECT_EQ(spectrum(1, 0), 0.25f);
  EXPECT_EQ(spectrum(1, 1), 4);
  EXPECT_EQ(value(1, 2), 0.5f);
  EXPECT_EQ(value(1, 3), 0.125f);
  EXPECT_EQ(spectrum(2, 0), 1.75f);
  EXPECT_EQ(value(2, 1), 0.0625f);
  EXPECT_EQ(value(2, 2), 0.5f);
  EXPECT_EQ(flat.materials[2].flags, 0u);
  glass.eta = SampledSpectrum{{400, 700}, {1.5, 1.6}};
  metal.eta = glass.eta;
  scene.materials[1].model = metal;
  scene.materials[2].model = glass;
  EXPECT_EQ(lower(scene).materials.at(1).flags, 0u);
  EXPECT_EQ(lower(scene).materials.at(2).flags, CAPLET_MATERIAL_DISPERSIVE);
}

TEST(FamilyData, TakesEveryFieldOnce) {
  float to[16] = {};
  FamilyData data(light_fields[light_spot], to);
  EXPECT_THROW(data.finish(), std::logic_error);
  EXPECT_THROW(data.put("no_such_field", 1.0), std::logic_error);
  EXPECT_THROW(data.put("axis", 1.0), std::logic_error);
  data.put("axis", glm::dvec3(1, 2, 3));
  EXPECT_THROW(data.put("axis", glm::dvec3(1, 2, 3)), std::logic_error);
  data.put("cos_falloff_start", 5);
  data.put("cos_total", 4);
  EXPECT_THROW(data.finish(), std::logic_error);
  data.put("position", glm::dvec3(-1, -2, -3));
  data.finish();
  EXPECT_EQ(std::vector<float>(to, to + 9), (std::vector<float>{-1, -2, -3, 1, 2, 3, 4, 5, 0}));
}

}  // namespace
}  // namespace caplet::test
