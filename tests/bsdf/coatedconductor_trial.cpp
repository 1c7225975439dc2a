// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include <numbers>

#include "coats.h"
#include "microfacets.h"
#include "trials.h"

namespace caplet::test {

BsdfTrial coatedconductor_trial() {
  BsdfTrial trial;
  trial.estimates = true;
  const auto metal = [](const char* name, float coat_alpha, float alpha_u, float alpha_v) {
    BsdfParameters out = coat(name, material_coatedconductor, coat_alpha);
    out.eta = 0.2f;
    out.k = 3.9f;
    out.alpha_u = alpha_u;
    out.alpha_v = alpha_v;
    return out;
  };
  const std::vector<double> thetas = {0.1, 0.9, 1.3, std::numbers::pi - 0.7};
  BsdfParameters under_haze = metal("coatedconductor under haze", 0.2f, 0, 0);
  under_haze.thickness = 0.5f;
  under_haze.albedo = 0.8f;
  for (const BsdfParameters& one : {metal("coatedconductor clear", 0, 0.3f, 0.3f),
                                    metal("coatedconductor rough", 0.2f, 0.2f, 0.4f),
                                    metal("coatedconductor mirror", 0.2f, 0, 0), under_haze})
    trial.cases.push_back({one, thetas});
  // No interface: the metal alone.
  for (const float alpha : {0.2f, 0.5f}) {
    BsdfParameters bare = metal("coatedconductor bare", 0, alpha, alpha);
    bare.coat_eta = 1;
    bare.thickness = 1e-30f;
    for (const auto& [o, i] : {std::pair(0.2, 0.5), std::pair(1.1, 0.8), std::pair(0.6, 1.4)}) {
      const Direction wo = direction(o, 0.3), wi = direction(i, 2.6);
      trial.values.push_back(
          {bare, wo, wi, microfacets(wo, wi, double{alpha}, double{alpha}, {0.2, 3.9}), 0, 1e-4});
    }
  }
  CoatedConductorMaterial model;
  model.eta = ConstantSpectrum{0.2};
  model.k = ConstantSpectrum{3.9};
  trial.model.model = model;
  trial.most = [](const BsdfParameters&, bool) { return 1.0; };
  trial.steps = [](const BsdfParameters&, double cos_theta) {
    return std::abs(cos_theta) < 0.3 ? 40 : 20;
  };
  return trial;
}

}  // namespace caplet::test
