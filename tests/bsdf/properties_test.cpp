// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// What BSDFs obey whatever their parameters: weights, reciprocity, Fresnel's closed forms, finite
// numbers; and values of Mitsuba 3.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <random>
#include <set>
#include <variant>

#include "lower/lower.h"
#include "shared/families.h"
#include "trials.h"

namespace caplet::test {
namespace {

// Rows without a BSDF.
constexpr std::size_t choices = 0
#define MATERIAL(name, traits)
#define CHOICE(name, traits) +1
#include "shared/materials.def"
#undef MATERIAL
    ;

/// Those that scatter over directions, of every material of the list whose values are no estimates.
std::vector<std::pair<const BsdfTrial*, BsdfParameters>> rough_ones() {
  std::vector<std::pair<const BsdfTrial*, BsdfParameters>> all;
  for (const MaterialOnTrial& material : materials_on_trial())
    for (const BsdfTrial::Case& one : material.trial.cases)
      if (!material.trial.estimates) all.emplace_back(&material.trial, one.bsdf);
  return all;
}

TEST(BsdfTrials, EveryMaterialOfTheModelIsOnTrial) {
  std::set<std::size_t> models;
  for (const MaterialOnTrial& material : materials_on_trial()) {
    EXPECT_FALSE(material.trial.cases.empty() && material.trial.samples.empty()) << material.name;
    EXPECT_FALSE(material.trial.values.empty() && material.trial.samples.empty()) << material.name;
    EXPECT_EQ(material.trial.estimates, (material_traits[material.kind] & trait_stochastic) != 0)
        << material.name;
    for (const BsdfTrial::Case& one : material.trial.cases)
      EXPECT_EQ(one.bsdf.kind, static_cast<uint>(material.kind)) << material.name;
    Scene scene;
    scene.materials = {material.trial.model};
    scene.shapes.emplace_back().geometry = SphereShape{1};
    EXPECT_EQ(lower(scene).materials.at(0).kind, static_cast<uint>(material.kind)) << material.name;
    models.insert(material.trial.model.model.index());
  }
  EXPECT_EQ(models.size(), std::variant_size_v<decltype(Material::model)> - choices);
}

// The weight is computed without dividing by the density; eval computes the half vector anew from
// wo and wi, which moves it by 2e-7 and the density by about 8 * 2e-7 / alpha relative; refraction
// near eta 1.5 magnifies that by 1.5 / 0.5 squared: 3e-4, and ten times that is allowed as cosines
// near grazing lose digits too.
TEST(BsdfSampling, WeightIsValueOverDensity) {
  for (const auto& [trial, bsdf] : rough_ones())
    for (const double theta : {0.1, 0.9, 1.4, 2.0, 3.0})
      for (const SampleRow& row :
           bsdf_on_device().sample(bsdf, direction(theta, 2), random_numbers(6000, 1))) {
        if (row.scattered == 0) continue;
        ASSERT_GT(row.pdf, 0);
        ASSERT_NEAR(row.value_pdf / row.pdf, 1, 3e-3) << bsdf.name << " at " << theta;
        ASSERT_NEAR(row.value / row.value_pdf, row.weight, 3e-3 * row.weight)
            << bsdf.name << " at " << theta;
        ASSERT_EQ(row.transmitted, row.wi[2] * std::cos(theta) < 0 ? 1.0f : 0.0f);
        ASSERT_EQ(row.specular, 0) << bsdf.name << " at " << theta;
        const float squared = trial->bends && row.transmitted != 0 ? bsdf.eta * bsdf.eta : 1;
        ASSERT_FLOAT_EQ(row.eta_scale, theta < 1.6 ? squared : 1 / squared);
      }
}

// f(wo, wi) = f(wi, wo) for reflection, and n_i^2 f(wo, wi) = n_o^2 f(wi, wo) for refraction of
// radiance (Veach 1997, 5.2). Both sides come from the same half vector to rounding: 1e-5 of
// relative error over alpha squared at the worst.
TEST(BsdfReciprocity, ReflectionAndRefraction) {
  std::mt19937 random(9);
  std::normal_distribution<float> normal;
  std::vector<Direction> wo, wi;
  for (int i = 0; i < 4000; ++i)
    for (std::vector<Direction>* list : {&wo, &wi}) {
      Direction d = {normal(random), normal(random), normal(random)};
      const float length = std::hypot(d[0], d[1], d[2]);
      for (float& c : d) c /= length;
      list->push_back(d);
    }
  for (const auto& [trial, bsdf] : rough_ones()) {
    if (!trial->reciprocal) continue;
    const std::vector<EvalRow> values = bsdf_on_device().evaluate(bsdf, wo, wi);
    int compared = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
      const double forward = double{values[i].value} / std::abs(double{wi[i][2]});
      double backward = double{values[i].exchanged} / std::abs(double{wo[i][2]});
      const double squared = trial->bends ? double{bsdf.eta} * double{bsdf.eta} : 1;
      if (wo[i][2] * wi[i][2] < 0) backward /= wo[i][2] > 0 ? squared : 1 / squared;
      if (!(std::abs(wo[i][2]) > 0.01f && std::abs(wi[i][2]) > 0.01f)) continue;
      ASSERT_NEAR(forward, backward, 4e-3 * std::max(forward, backward) + 1e-5) << bsdf.name;
      compared += forward > 1e-4;
    }
    EXPECT_GT(compared, 200) << bsdf.name;
  }
}

// --- Fresnel ---

/// Reflectance at n + i k by complex arithmetic in double.
double reflectance(double cos_i, std::complex<double> index) {
  const std::complex<double> sin2 = 1 - cos_i * cos_i,
                             cos_t = std::sqrt(1.0 - sin2 / (index * index));
  const std::complex<double> s = (cos_i - index * cos_t) / (cos_i + index * cos_t),
                             p = (index * cos_i - cos_t) / (index * cos_i + cos_t);
  return 0.5 * (std::norm(s) + std::norm(p));
}

SampleRow first_sample(const BsdfParameters& bsdf, double theta, float component) {
  return bsdf_on_device().sample(bsdf, direction(theta, 0.4), {component, 0.3f, 0.6f}).front();
}

TEST(BsdfFresnel, SmoothMetal) {
  const std::pair<double, double> metals[] = {{0.2, 3.9}, {1.5, 7.6}, {0.05, 4.4},
                                              {2.9, 3.0}, {1.5, 0.0}, {4.0, 0.01}};
  for (const auto& [n, k] : metals)
    for (const double theta : {0.0, 0.3, 0.9, 1.3, 1.5, 1.57}) {
      const BsdfParameters metal = {"", material_conductor,    0,
                                    1,  static_cast<float>(n), static_cast<float>(k)};
      const SampleRow row = first_sample(metal, theta, 0.5f);
      ASSERT_EQ(row.scattered, 1);
      EXPECT_EQ(row.specular, 1);
      // e = n^2 - k^2 - sin^2 cancels to 1e-7 of n^2 + k^2, and its root to the square root of that
      // where n or k vanishes.
      EXPECT_NEAR(row.weight, reflectance(double{direction(theta, 0.4)[2]}, {n, k}),
                  k < 0.1 ? 2e-4 : 2e-5)
          << n << ' ' << k << ' ' << theta;
      EXPECT_EQ(row.value, 0);  // nothing but a delta
    }
}

TEST(BsdfFresnel, ClearGlass) {
  for (const float eta : {1.33f, 1.5f, 2.4f, 0.8f})
    for (const double theta : {0.0, 0.5, 1.0, 1.4, 1.7, 2.2, 2.8, 3.1}) {
      const BsdfParameters glass = {"", material_dielectric, 0, 1, eta, 0};
      const double cos_o = std::cos(theta), relative = cos_o > 0 ? double{eta} : 1 / double{eta};
      const double sin_t = std::sin(theta) / relative,
                   expected = sin_t < 1 ? reflectance(std::abs(cos_o), relative) : 1;
      const SampleRow mirrored = first_sample(glass, theta, 0);
      ASSERT_EQ(mirrored.scattered, 1);
      EXPECT_NEAR(mirrored.pdf, expected, 1e-5);
      EXPECT_EQ(mirrored.weight, 1);
      EXPECT_NEAR(mirrored.wi[2], cos_o, 1e-6);
      const SampleRow refracted = first_sample(glass, theta, 0x1.fffffep-1f);
      ASSERT_EQ(refracted.scattered, 1);
      if (sin_t >= 1) {
        EXPECT_EQ(refracted.transmitted, 0);  // total internal reflection
        continue;
      }
      EXPECT_NEAR(refracted.pdf, 1 - expected, 1e-5);
      EXPECT_NEAR(refracted.weight, 1 / (relative * relative), 1e-5 / (relative * relative));
      EXPECT_NEAR(std::hypot(refracted.wi[0], refracted.wi[1]), sin_t, 2e-6);  // Snell
      EXPECT_NEAR(refracted.eta_scale, relative * relative, 1e-5 * relative * relative);
      EXPECT_LT(refracted.wi[2] * cos_o, 0);
      // In the plane of incidence, to the other side.
      if (theta > 0) {
        EXPECT_NEAR(std::atan2(refracted.wi[1], refracted.wi[0]), 0.4 - std::numbers::pi, 1e-5);
      }
    }
}

TEST(BsdfFresnel, RoughnessTowardsZeroIsSmooth) {
  const BsdfParameters rough = {"", material_conductor, 0, 1, 0.2f, 3.9f, 2e-3f, 2e-3f};
  const double expected = reflectance(std::cos(0.9), {0.2, 3.9});
  for (const SampleRow& row :
       bsdf_on_device().sample(rough, direction(0.9, 0.4), random_numbers(3000, 2))) {
    ASSERT_EQ(row.scattered, 1);
    ASSERT_EQ(row.specular, 0);
    ASSERT_NEAR(row.weight, expected,
                3e-3);  // masking is 1 - O(alpha^2), Fresnel's slope times the lobe's width
  }
  BsdfParameters matched = {"",  material_dielectric, 0, 1, 1, 0, 0.5f,
                            0.5f};  // no interface at all
  const SampleRow row = first_sample(matched, 0.9, 0.5f);
  EXPECT_EQ(row.specular, 1);
  EXPECT_EQ(row.transmitted, 1);
  EXPECT_EQ(row.weight, 1);
}

TEST(BsdfDispersion, HeroWavelengthAlone) {
  BsdfParameters glass = {"",  material_dielectric, CAPLET_MATERIAL_DISPERSIVE, 1, 1.5f, 0, 0.2f,
                          0.2f};
  SampleRow row = first_sample(glass, 0.3, 0.9f);
  EXPECT_GT(row.weight, 0);
  EXPECT_EQ(row.weight_second, 0);
  glass.flags = 0;
  row = first_sample(glass, 0.3, 0.9f);
  EXPECT_EQ(row.weight_second, row.weight);
}

// --- Numbers ---

TEST(BsdfRobustness, FiniteAndBoundedForAnyInput) {
  std::mt19937 random(4);
  std::uniform_real_distribution<float> uniform(0, 1);
  const float alphas[] = {0, 1e-4f, 9e-4f, 1e-3f, 0.01f, 0.1f, 1.0f},
              etas[] = {1e-2f, 0.5f, 1.0f, 1.0001f, 1.0002f, 1.5f, 3.0f, 1e2f},
              extinctions[] = {0, 1e-3f, 1, 1e4f};
  const float edges[] = {0, 0x1p-24f, 0.5f, 1 - 0x1p-24f};
  const double thetas[] = {0,        1e-4,   0.5,   1.57, 1.5707,
                           1.570796, 1.5708, 1.571, 2.5,  std::numbers::pi};
  for (int i = 0; i < 400; ++i) {
    BsdfParameters bsdf;
    const MaterialOnTrial& material =
        materials_on_trial()[static_cast<std::size_t>(i) % materials_on_trial().size()];
    bsdf.kind = static_cast<uint>(material.kind);
    bsdf.alpha_u = alphas[random() % 7];
    bsdf.alpha_v = alphas[random() % 7];
    if (std::max(bsdf.alpha_u, bsdf.alpha_v) >= CAPLET_ALPHA_SMOOTH) {  // as bsdf_make
      bsdf.alpha_u = std::max(bsdf.alpha_u, CAPLET_ALPHA_MIN);
      bsdf.alpha_v = std::max(bsdf.alpha_v, CAPLET_ALPHA_MIN);
    }
    if (random() % 2) bsdf.flags = CAPLET_MATERIAL_MULTISCATTER;
    bsdf.eta = etas[random() % 8];
    bsdf.k = extinctions[random() % 4];
    if (bsdf.kind == material_hair) bsdf.eta = std::max(bsdf.eta, 1.0f);
    if (bsdf.kind == material_hair) {  // as hair_make
      bsdf.alpha_u = std::max(bsdf.alpha_u, 0.01f);
      bsdf.alpha_v = std::max(bsdf.alpha_v, 0.01f);
      bsdf.hair_tilt = 0.03f;
    }
    bsdf.reflectance = bsdf.transmittance = 0.5f;
    bsdf.coat_eta = etas[random() % 8];
    bsdf.coat_alpha_u = bsdf.coat_alpha_v = alphas[random() % 7];
    bsdf.thickness = std::array{1e-30f, 0.01f, 3.0f}[random() % 3];
    bsdf.albedo = std::array{0.0f, 0.5f, 1.0f}[random() % 3];
    bsdf.g = std::array{0.0f, 0.99f, -0.99f, 0.3f}[random() % 4];
    bsdf.max_depth = std::array{0.0f, 3.0f, 100.0f}[random() % 3];
    const Direction wo = direction(thetas[random() % 10], 6 * uniform(random));
    std::vector<float> u = random_numbers(3 * 128, static_cast<unsigned>(i));
    for (std::size_t j = 0; j < 96; ++j) u[j] = edges[random() % 4];
    if (bsdf.kind == material_principled) {  // as principled_make
      bsdf.eta = std::max(bsdf.eta, 1.001f);
      bsdf.coat_eta = std::max(bsdf.coat_eta, 1.0f);
      bsdf.k = std::min(bsdf.k, 1.0f);
      for (float* alpha : {&bsdf.alpha_u, &bsdf.alpha_v, &bsdf.coat_alpha_u})
        *alpha = std::max(*alpha, CAPLET_ALPHA_SMOOTH);
      bsdf.principled_roughness = std::sqrt(bsdf.alpha_u);
      bsdf.principled_metallic = std::array{0.0f, 0.5f, 1.0f}[random() % 3];
      bsdf.principled_transmission =
          (1 - bsdf.principled_metallic) * std::array{0.0f, 0.5f, 1.0f}[random() % 3];
      bsdf.principled_coat = std::array{0.0f, 0.5f, 1.0f}[random() % 3];
      bsdf.principled_tint = std::array{0.0f, 0.5f, 1.0f}[random() % 3];
      bsdf.principled_normal_tinted = std::array{0.0f, 0.04f, 1.0f}[random() % 3];
    }
    // A sample of the lobe that makes up for losses weighs the loss over its mean at the most: 60
    // for indices next to 1, 12 for glass, 6 for metals.
    const double heaviest = bsdf.flags != 0 ? 64 : material.trial.heaviest;
    const double most = heaviest * material.trial.most(bsdf, wo[2] < 0);
    std::vector<Direction> other, same;
    for (const SampleRow& row : bsdf_on_device().sample(bsdf, wo, u)) {
      for (const float value : {row.wi[0], row.wi[1], row.wi[2], row.pdf, row.weight, row.value,
                                row.value_pdf, row.eta_scale})
        ASSERT_TRUE(std::isfinite(value)) << i;
      ASSERT_GE(row.weight, 0) << i;
      ASSERT_LE(row.weight, most * 1.00001) << i;
      if (row.scattered == 0) continue;
      ASSERT_GT(row.pdf, 0) << i;
      ASSERT_NEAR(std::hypot(row.wi[0], row.wi[1], row.wi[2]), 1, 2e-6) << i;
      other.push_back(direction(thetas[random() % 10], 6 * uniform(random)));
      same.push_back(wo);
    }
    if (other.empty()) continue;
    for (const EvalRow& row : bsdf_on_device().evaluate(bsdf, same, other))
      for (const float value : {row.value, row.pdf, row.exchanged, row.exchanged_pdf}) {
        ASSERT_TRUE(std::isfinite(value)) << i;
        ASSERT_GE(value, 0) << i;
      }
  }
}

// --- Closed forms, and another renderer ---

TEST(BsdfAgainstMitsuba, ValuesAndDensities) {
  for (const MaterialOnTrial& material : materials_on_trial())
    for (const KnownValue& known : material.trial.values) {
      if (material.trial.estimates) continue;
      const EvalRow ours = bsdf_on_device().evaluate(known.bsdf, {known.wo}, {known.wi}).front();
      EXPECT_NEAR(ours.value, known.value, known.tolerance * known.value) << known.bsdf.name;
      if (known.pdf < 0) continue;
      EXPECT_NEAR(ours.pdf, known.pdf, known.tolerance * known.pdf) << known.bsdf.name;
    }
}

TEST(BsdfKnownSamples, OfDeltaScattering) {
  for (const MaterialOnTrial& material : materials_on_trial())
    for (const KnownSample& known : material.trial.samples) {
      const SampleRow row =
          bsdf_on_device().sample(known.bsdf, known.wo, {known.u_component, 0.3f, 0.6f}).front();
      ASSERT_EQ(row.scattered, 1) << known.bsdf.name;
      EXPECT_EQ(row.specular, 1) << known.bsdf.name;
      EXPECT_EQ(row.transmitted, known.wo[2] * known.wi[2] < 0 ? 1.0f : 0.0f) << known.bsdf.name;
      EXPECT_EQ(row.eta_scale, 1) << known.bsdf.name;
      EXPECT_EQ(row.value, 0) << known.bsdf.name;
      EXPECT_NEAR(row.weight, known.weight, known.tolerance) << known.bsdf.name;
      EXPECT_NEAR(row.pdf, known.pdf, known.tolerance) << known.bsdf.name;
      for (std::size_t c = 0; c < 3; ++c)
        EXPECT_NEAR(row.wi[c], known.wi[c], 1e-6) << known.bsdf.name;
    }
}

}  // namespace
}  // namespace caplet::test
