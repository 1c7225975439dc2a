// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include <algorithm>
#include <cmath>
#include <numbers>

#include "mitsuba_principled.h"
#include "trials.h"

namespace caplet::test {

BsdfTrial principled_trial() {
  using std::numbers::pi;
  BsdfTrial trial;
  trial.bends = true;
  const std::vector<double> both_sides = {0.1, 0.7, 1.3, pi - 0.4, pi - 1.2};
  BsdfParameters plastic = principled("principled plastic", 0.8f, 0.4f),
                 white = principled("principled white", 1, 0.9f),
                 metal = principled("principled metal", 0.7f, 0.5f, 0.8f),
                 glass = principled("principled glass", 0.9f, 0.5f),
                 cloth = principled("principled cloth", 0.6f, 0.8f),
                 coated = principled("principled coated", 0.5f, 0.7f),
                 all = principled("principled all", 0.6f, 0.6f, 0.5f);
  metal.principled_metallic = 1;
  glass.principled_transmission = 1;
  cloth.k = 1;
  cloth.principled_tint = 0.5f;
  cloth.principled_normal_tinted = 0.06f;
  coated.principled_coat = 1;
  coated.coat_alpha_u = 0.1f;
  all.principled_metallic = 0.3f;
  all.principled_transmission = 0.3f;
  all.k = 0.5f;
  all.principled_coat = 0.5f;
  all.coat_alpha_u = 0.3f;
  all.albedo = 0.8f;
  for (const BsdfParameters& one : {plastic, white, metal, glass, cloth, coated, all})
    trial.cases.push_back({one, both_sides});
  BsdfParameters other = all;
  other.principled_metallic = 0.4f;
  BsdfParameters rougher = principled("principled rougher metal", 0.7f, 0.55f, 0.8f);
  rougher.principled_metallic = 1;
  trial.unlike = {{all, other}, {metal, rougher}};
  for (const PrincipledRow& row : principled_rows) {
    const double more = correlated_over_separable(row.wo, row.wi, double{row.bsdf.alpha_u},
                                                  double{row.bsdf.alpha_v}) -
                        1;
    trial.values.push_back(
        {row.bsdf, row.wo, row.wi, row.value + more * facets_of_mitsuba(row), -1, 3e-4});
  }
  trial.model.model = PrincipledMaterial{};
  trial.most = [](const BsdfParameters& bsdf, bool inside) {
    return inside && bsdf.principled_transmission > 0 ? double{bsdf.eta} * double{bsdf.eta} : 1.0;
  };
  trial.heaviest = 4;  // shares of samples go by what smooth facets reflect
  trial.steps = [](const BsdfParameters&, double cos_theta) {
    return std::abs(cos_theta) < 0.3 ? 48 : 32;
  };
  return trial;
}

}  // namespace caplet::test
