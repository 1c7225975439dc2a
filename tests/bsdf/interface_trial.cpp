// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "trials.h"

namespace caplet::test {

// Straight on, whatever the numbers.
BsdfTrial interface_trial() {
  BsdfTrial trial;
  const BsdfParameters nothing = {"interface", material_interface};
  for (const double theta : {0.2, 1.1, 1.5, 2.4})
    for (const float u : {0.f, 0.5f, 0x1.fffffep-1f}) {
      const Direction wo = direction(theta, 0.4);
      trial.samples.push_back({nothing, wo, u, {-wo[0], -wo[1], -wo[2]}, 1, 1, 1e-7});
    }
  trial.model.model = InterfaceMaterial{};
  trial.most = [](const BsdfParameters&, bool) { return 1.0; };
  trial.steps = [](const BsdfParameters&, double) { return 16; };
  return trial;
}

}  // namespace caplet::test
