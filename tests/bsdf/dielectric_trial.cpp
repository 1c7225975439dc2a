// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include <algorithm>
#include <cmath>
#include <numbers>

#include "mitsuba_values.h"
#include "trials.h"

namespace caplet::test {

namespace {

BsdfParameters glass(float alpha_u, float alpha_v, float eta = 1.5f) {
  return {"dielectric " + std::to_string(alpha_u) + ' ' + std::to_string(alpha_v),
          material_dielectric,
          0,
          1,
          eta,
          0,
          alpha_u,
          alpha_v};
}

}  // namespace

BsdfTrial dielectric_trial() {
  BsdfTrial trial;
  trial.bends = true;
  for (const auto& [u, v] : roughnesses)
    trial.cases.push_back(
        {glass(u, v), {0.0, 0.7, 1.3, 1.52, std::numbers::pi - 0.4, std::numbers::pi - 1.2}});
  for (const auto& [u, v] : {std::pair(0.3f, 0.3f), std::pair(0.8f, 0.8f), std::pair(0.1f, 0.4f)}) {
    BsdfParameters more = glass(u, v);
    more.name += " multiscatter";
    more.flags = CAPLET_MATERIAL_MULTISCATTER;
    trial.cases.push_back({more, {0.0, 0.7, 1.3, std::numbers::pi - 0.4, std::numbers::pi - 1.2}});
  }
  trial.unlike = {{glass(0.3f, 0.3f), glass(0.3f, 0.3f, 1.55f)}};
  for (const MitsubaRow& row : mitsuba_rows)
    if (row.kind == material_dielectric)
      trial.values.push_back(
          {glass(row.alpha_u, row.alpha_v), row.wo, row.wi,
           row.value *
               correlated_over_separable(row.wo, row.wi, double{row.alpha_u}, double{row.alpha_v}),
           row.pdf, mitsuba_tolerance});
  trial.model.model = DielectricMaterial{};
  // Radiance that enters the medium of lower index is greater there by the square of their ratio's
  // inverse.
  trial.most = [](const BsdfParameters& bsdf, bool inside) {
    const double into = inside ? 1 / double{bsdf.eta} : double{bsdf.eta};
    return std::max(1.0, 1 / (into * into));
  };
  // Refraction narrows the lobe by eta - 1, and at grazing ends in an edge.
  trial.steps = [](const BsdfParameters& bsdf, double cos_theta) {
    const bool grazing = std::abs(cos_theta) < 0.1;
    if (std::min(bsdf.alpha_u, bsdf.alpha_v) < 0.2f) return grazing ? 80 : 40;
    return grazing ? 48 : 16;
  };
  return trial;
}

}  // namespace caplet::test
