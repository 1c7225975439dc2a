// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <optional>

#include "scene/materials/coat_layer.h"
#include "scene/materials/composites.h"
#include "scene/spectrum.h"

namespace caplet {

/// A metal under a dielectric interface. Roughness and reflectance have the meaning that they have
/// in ConductorMaterial; the metal's index is relative to the interface's.
struct CoatedConductorMaterial {
  Spectrum interface_eta = ConstantSpectrum{1.5};
  double interface_alpha_u = 0, interface_alpha_v = 0;
  Spectrum eta = copper_eta(), k = copper_k();
  std::optional<Spectrum> reflectance;
  double alpha_u = 0, alpha_v = 0;
  CoatLayer layer;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit.index({"interface.eta", "index of refraction of the coat", 0}, self.interface_eta);
    visit.roughness(interface_roughness, self.interface_alpha_u, self.interface_alpha_v);
    visit.metal(coated_metal, self.eta, self.k, self.reflectance);
    visit.roughness(conductor_roughness, self.alpha_u, self.alpha_v);
    CoatLayer::fields(self.layer, visit);
  }
};

}  // namespace caplet
