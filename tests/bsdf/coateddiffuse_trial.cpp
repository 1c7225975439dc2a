// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include <numbers>

#include "coats.h"
#include "trials.h"

namespace caplet::test {

BsdfTrial coateddiffuse_trial() {
  BsdfTrial trial;
  trial.estimates = true;
  const std::vector<double> thetas = {0.1, 0.9, 1.4, std::numbers::pi - 0.7};
  BsdfParameters clear = coat("coateddiffuse clear", material_coateddiffuse, 0),
                 rough = coat("coateddiffuse rough", material_coateddiffuse, 0.3f),
                 thick = coat("coateddiffuse thick", material_coateddiffuse, 0.1f);
  clear.reflectance = 0.5f;
  rough.reflectance = 0.8f;
  rough.coat_alpha_v = 0.5f;
  thick.reflectance = 0.6f;
  thick.thickness = 0.4f;
  thick.albedo = 0.7f;
  thick.g = 0.3f;
  BsdfParameters milky = coat("coateddiffuse milky", material_coateddiffuse, 0);
  milky.reflectance = 0.3f;
  milky.thickness = 1;
  milky.albedo = 0.9f;
  milky.g = -0.4f;
  for (const BsdfParameters& one : {clear, rough, thick, milky})
    trial.cases.push_back({one, thetas});

  // Nothing absorbs between a clear interface and Lambert's law: T(wo) T(wi) rho / (pi eta^2 (1 -
  // rho R)), R: internal reflectance.
  BsdfParameters thin = clear;
  thin.name = "coateddiffuse thin";
  thin.thickness = 1e-30f;
  for (const float reflectance : {0.5f, 1.0f}) {
    thin.reflectance = reflectance;
    for (const auto& [o, i] : {std::pair(0.2, 0.5), std::pair(1.1, 0.8), std::pair(0.6, 1.4)}) {
      const double rho = double{reflectance},
                   through = (1 - fresnel(std::cos(o), 1.5)) * (1 - fresnel(std::cos(i), 1.5));
      const double f =
          through * rho / (std::numbers::pi * 2.25 * (1 - rho * internal_reflectance(1.5)));
      trial.values.push_back({thin, direction(o, 0.3), direction(i, 2), f * std::cos(i), 0, 1e-4});
    }
  }
  // No interface: what the layer extinguishes on the way in and out; and, over black, what it
  // scatters once (Chandrasekhar 1960).
  BsdfParameters bare = coat("coateddiffuse bare", material_coateddiffuse, 0), haze = bare;
  bare.coat_eta = haze.coat_eta = 1;
  bare.reflectance = 0.5f;
  bare.thickness = 0.3f;
  haze.name = "coateddiffuse haze";
  haze.reflectance = 0;
  haze.thickness = 0.7f;
  haze.albedo = 0.6f;
  haze.g = 0.5f;
  haze.max_depth = 1;
  for (const auto& [o, i] : {std::pair(0.2, 0.5), std::pair(1.1, 0.8), std::pair(0.6, 1.4)}) {
    const double mu_o = std::cos(o), mu_i = std::cos(i), slant = 1 / mu_o + 1 / mu_i;
    const Direction wo = direction(o, 0.3), wi = direction(i, 2);
    trial.values.push_back(
        {bare, wo, wi, 0.5 / std::numbers::pi * mu_i * std::exp(-double{0.3f} * slant), 0, 1e-5});
    double turn = 0;  // cosine from the way in to the way out
    for (std::size_t c = 0; c < 3; ++c) turn -= double{wo[c]} * double{wi[c]};
    const double g = 0.5, phase = (1 - g * g) / std::pow(1 + g * g - 2 * g * turn, 1.5) /
                                  (4 * std::numbers::pi);
    const double single =
        double{0.6f} * phase / (mu_o + mu_i) * (1 - std::exp(-double{0.7f} * slant));
    trial.values.push_back({haze, wo, wi, single * mu_i, 0, 1e-5});
  }
  trial.model.model = CoatedDiffuseMaterial{};
  trial.most = [](const BsdfParameters&, bool) { return 1.0; };
  trial.steps = [](const BsdfParameters&, double cos_theta) {
    return std::abs(cos_theta) < 0.2 ? 32 : 16;
  };
  return trial;
}

}  // namespace caplet::test
