// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include <algorithm>
#include <cmath>
#include <numbers>

#include "trials.h"

namespace caplet::test {

namespace {

BsdfParameters sheet(float reflectance, float transmittance) {
  BsdfParameters out = {"diffusetransmission", material_diffusetransmission, 0, reflectance, 1};
  out.transmittance = transmittance;
  return out;
}

}  // namespace

BsdfTrial diffusetransmission_trial() {
  BsdfTrial trial;
  const BsdfParameters leaf = sheet(0.3f, 0.6f);
  trial.cases = {{leaf, {0.3, 1.5, 2.5}}, {sheet(0.7f, 0), {0.9}}, {sheet(0, 0.8f), {0.9, 2.2}}};
  trial.unlike = {{leaf, sheet(0.3f, 0.45f)}};
  // Lambert on both sides; the share of samples on each is that of its albedo.
  for (const double theta_o : {0.3, 1.5, 2.5})
    for (const double theta : {0.1, 0.8, 1.4, 2.0, 3.0}) {
      const Direction wo = direction(theta_o, 0.4), wi = direction(theta, 2);
      const bool reflected = wo[2] * wi[2] > 0;
      const double cosine = std::abs(double{wi[2]}) / std::numbers::pi, r = double{0.3f},
                   t = double{0.6f};
      trial.values.push_back({leaf, wo, wi, cosine * (reflected ? r : t),
                              cosine * (reflected ? r : t) / (r + t), 8 * 0x1p-24});
    }
  trial.model.model = DiffuseTransmissionMaterial{};
  trial.most = [](const BsdfParameters& bsdf, bool) {
    return std::min(1.0, double{bsdf.reflectance} + double{bsdf.transmittance});
  };
  trial.steps = [](const BsdfParameters&, double) { return 16; };
  return trial;
}

}  // namespace caplet::test
