// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include "scene/materials/composites.h"
#include "scene/spectrum.h"

namespace caplet {

/// Roughness and multiscatter have the meaning that they have in ConductorMaterial.
struct DielectricMaterial {
  Spectrum eta = ConstantSpectrum{1.5};
  double alpha_u = 0, alpha_v = 0;
  bool multiscatter = false;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit.index({"eta", "index of refraction inside, relative to outside", 0}, self.eta);
    visit.roughness(surface_roughness, self.alpha_u, self.alpha_v);
    visit.flag(multiscatter_field, self.multiscatter);
  }
};

}  // namespace caplet
