// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include "scene/spectrum.h"

namespace caplet {

/// Metal, glass and a diffuse base under an interface, mixed, below a coat (Burley 2012, 2015; docs/materials.md). Weights and
/// roughnesses are from 0 to 1; the square of a roughness is GGX's alpha.
struct PrincipledMaterial {
  Spectrum base_color = ConstantSpectrum{0.5};
  double metallic = 0;
  double roughness = 0.5;
  double anisotropic = 0;
  double eta = 1.5;
  double spec_tint = 0;
  double spec_trans = 0;
  double sheen = 0, sheen_tint = 0;
  double coat = 0, coat_roughness = 0, coat_eta = 1.5;
  Spectrum coat_color = ConstantSpectrum{1};

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit.albedo("base_color", self.base_color);
    visit.number("metallic", self.metallic, 0, 1);
    visit.number("roughness", self.roughness, 0, 1);
    visit.number("anisotropic", self.anisotropic, 0, 1);
    visit.number("eta", self.eta, 1, 100);
    visit.number("spec_tint", self.spec_tint, 0, 1);
    visit.number("spec_trans", self.spec_trans, 0, 1);
    visit.number("sheen", self.sheen, 0, 1);
    visit.number("sheen_tint", self.sheen_tint, 0, 1);
    visit.number("coat", self.coat, 0, 1);
    visit.number("coat_roughness", self.coat_roughness, 0, 1);
    visit.number("coat_eta", self.coat_eta, 1, 100);
    visit.albedo("coat_color", self.coat_color);
  }
};

}  // namespace caplet
