// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <optional>

#include "scene/spectrum.h"

namespace caplet {

/// A fibre, whose axis is along dp/dv (docs/materials.md). sigma_a: absorption per radius; reflectance: the colour that many
/// fibres are to have together, which replaces it. beta_m, beta_n: roughness along and around; alpha: tilt of the scales in
/// degrees.
struct HairMaterial {
  Spectrum sigma_a = ConstantSpectrum{0};
  std::optional<Spectrum> reflectance;
  double eta = 1.55;
  double beta_m = 0.3, beta_n = 0.3;
  double alpha = 2;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit.pigment(self.sigma_a, self.reflectance);
    visit.number("eta", self.eta, 1, 10);
    visit.number("beta_m", self.beta_m, 0, 1);
    visit.number("beta_n", self.beta_n, 0, 1);
    visit.number("alpha", self.alpha, -90, 90);
  }
};

}  // namespace caplet
