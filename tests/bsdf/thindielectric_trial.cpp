// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include <cmath>

#include "trials.h"

namespace caplet::test {

namespace {

/// Returns the reflectance of one face, by Fresnel's equations in double.
double face(double cos_i, double eta) {
  const double cos_t = std::sqrt(1 - (1 - cos_i * cos_i) / (eta * eta));
  const double parallel = (eta * cos_i - cos_t) / (eta * cos_i + cos_t),
               across = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
  return 0.5 * (parallel * parallel + across * across);
}

}  // namespace

// A pane of two faces that reflect r each lets (1 - r)^2 (1 + r^2 + r^4 + ...) = (1 - r) / (1 + r)
// through, and reflects the rest.
BsdfTrial thindielectric_trial() {
  BsdfTrial trial;
  for (const float eta : {1.33f, 1.5f, 2.4f})
    for (const double theta : {0.2, 1.1, 1.5, 2.4}) {
      const BsdfParameters pane = {"thindielectric " + std::to_string(eta), material_thindielectric,
                                   0, 1, eta};
      const Direction wo = direction(theta, 0.4);
      const double r = face(std::abs(std::cos(theta)), double{eta}), through = (1 - r) / (1 + r);
      trial.samples.push_back({pane, wo, 0, {-wo[0], -wo[1], wo[2]}, 1, 1 - through, 2e-6});
      trial.samples.push_back(
          {pane, wo, 0x1.fffffep-1f, {-wo[0], -wo[1], -wo[2]}, 1, through, 2e-6});
    }
  trial.model.model = ThinDielectricMaterial{};
  trial.most = [](const BsdfParameters&, bool) { return 1.0; };
  trial.steps = [](const BsdfParameters&, double) { return 16; };
  return trial;
}

}  // namespace caplet::test
