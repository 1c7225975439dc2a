// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include <algorithm>
#include <cmath>
#include <numbers>

#include "microfacets.h"
#include "trials.h"

namespace caplet::test {

namespace {

BsdfParameters metal(float alpha_u, float alpha_v) {
  return {"conductor " + std::to_string(alpha_u) + ' ' + std::to_string(alpha_v),
          material_conductor,
          0,
          1,
          0.2f,
          3.9f,
          alpha_u,
          alpha_v};
}

}  // namespace

BsdfTrial conductor_trial() {
  BsdfTrial trial;
  for (const auto& [u, v] : roughnesses)
    trial.cases.push_back({metal(u, v), {0.0, 0.7, 1.3, 1.52, std::numbers::pi - 0.7}});
  for (const auto& [u, v] : roughnesses) {
    BsdfParameters more = metal(u, v);
    more.name += " multiscatter";
    more.flags = CAPLET_MATERIAL_MULTISCATTER;
    trial.cases.push_back({more, {0.0, 0.7, 1.3, std::numbers::pi - 0.7}});
  }
  const BsdfParameters uneven = metal(0.1f, 0.4f);
  trial.unlike = {{uneven, metal(0.1f, 0.45f)}, {uneven, metal(0.4f, 0.1f)}};
  for (const MitsubaRow& row : mitsuba_rows)
    if (row.kind == material_conductor)
      trial.values.push_back(
          {metal(row.alpha_u, row.alpha_v), row.wo, row.wi,
           row.value *
               correlated_over_separable(row.wo, row.wi, double{row.alpha_u}, double{row.alpha_v}),
           row.pdf, mitsuba_tolerance});
  for (const auto& [u, v] : roughnesses)
    for (const auto& [o, i] :
         {std::pair(0.2, 0.5), std::pair(1.1, 0.8), std::pair(0.6, 1.4), std::pair(1.45, 1.3)}) {
      const Direction wo = direction(o, 0.3), wi = direction(i, 2.9);
      trial.values.push_back({metal(u, v), wo, wi,
                              microfacets(wo, wi, double{u}, double{v}, {0.2, 3.9}), -1,
                              mitsuba_tolerance});
    }
  ConductorMaterial model;
  model.eta = ConstantSpectrum{0.2};
  model.k = ConstantSpectrum{3.9};
  trial.model.model = model;
  trial.most = [](const BsdfParameters&, bool) { return 1.0; };
  // Towards grazing the lobe's azimuth is alpha cos(theta) wide.
  trial.steps = [](const BsdfParameters& bsdf, double cos_theta) {
    if (std::min(bsdf.alpha_u, bsdf.alpha_v) >= 0.2f) return 16;
    return std::abs(cos_theta) < 0.1 ? 80 : 24;
  };
  return trial;
}

}  // namespace caplet::test
