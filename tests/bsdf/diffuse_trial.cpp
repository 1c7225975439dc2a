// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include <cmath>
#include <numbers>

#include "trials.h"

namespace caplet::test {

BsdfTrial diffuse_trial() {
  BsdfTrial trial;
  const BsdfParameters white = {"diffuse", material_diffuse},
                       grey = {"grey diffuse", material_diffuse, 0, 0.7f};
  trial.cases = {{white, {0.3, 1.5, 2.5}}, {grey, {0.9}}};
  // Lambert: reflectance / pi times the cosine, and the cosine over pi; nothing through the
  // surface.
  for (const double theta_o : {0.3, 1.5, 2.5})
    for (const double theta : {0.1, 0.8, 1.4, 2.0, 3.0}) {
      const Direction wo = direction(theta_o, 0.4), wi = direction(theta, 2);
      const double cosine = wo[2] * wi[2] > 0 ? std::abs(double{wi[2]}) : 0,
                   pdf = cosine / std::numbers::pi;
      trial.values.push_back({grey, wo, wi, double{0.7f} * pdf, pdf,
                              4 * 0x1p-24});  // three products, and pi as a float
    }
  trial.model.model = DiffuseMaterial{};
  trial.most = [](const BsdfParameters& bsdf, bool) { return double{bsdf.reflectance}; };
  trial.steps = [](const BsdfParameters&, double) { return 16; };
  return trial;
}

}  // namespace caplet::test
