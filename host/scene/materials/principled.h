// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include "scene/field.h"
#include "scene/spectrum.h"

namespace caplet {

/// Metal, glass and a diffuse base under an interface, mixed, below a coat (Burley 2012, 2015;
/// docs/materials.md). Weights and roughnesses are from 0 to 1; the square of a roughness is GGX's
/// alpha.
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
    visit.albedo({"base_color", "colour of the base, and of metal at normal incidence", 0, 1},
                 self.base_color);
    visit.number({"metallic", "share of metal", 0, 1}, self.metallic);
    visit.number({"roughness", "roughness; its square is GGX's alpha", 0, 1}, self.roughness);
    visit.number({"anisotropic", "how much longer highlights are along dp/du", 0, 1},
                 self.anisotropic);
    visit.number({"eta", "index of refraction inside", 1, 100}, self.eta);
    visit.number({"spec_tint", "how much highlights take the base's hue", 0, 1}, self.spec_tint);
    visit.number({"spec_trans", "share of glass", 0, 1}, self.spec_trans);
    visit.number({"sheen", "sheen at grazing angles, as of cloth", 0, 1}, self.sheen);
    visit.number({"sheen_tint", "how much the sheen takes the base's hue", 0, 1}, self.sheen_tint);
    visit.number({"coat", "share of the surface that is coated", 0, 1}, self.coat);
    visit.number({"coat_roughness", "roughness of the coat; its square is GGX's alpha", 0, 1},
                 self.coat_roughness);
    visit.number({"coat_eta", "index of refraction of the coat", 1, 100}, self.coat_eta);
    visit.albedo({"coat_color", "transmittance of the coat, there and back", 0, 1},
                 self.coat_color);
  }
};

}  // namespace caplet
