// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include <algorithm>
#include <cmath>
#include <numbers>

#include "mitsuba_values.h"
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
  for (const auto& [u, v] : roughnesses) trial.cases.push_back({metal(u, v), {0.0, 0.7, 1.3, 1.52, std::numbers::pi - 0.7}});
  const BsdfParameters uneven = metal(0.1f, 0.4f);
  trial.unlike = {{uneven, metal(0.1f, 0.45f)}, {uneven, metal(0.4f, 0.1f)}};
  for (const MitsubaRow& row : mitsuba_rows)
    if (row.kind == material_conductor)
      trial.values.push_back({metal(row.alpha_u, row.alpha_v), row.wo, row.wi, row.value, row.pdf, mitsuba_tolerance});
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
