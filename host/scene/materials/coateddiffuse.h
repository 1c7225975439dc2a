// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include "scene/materials/coat_layer.h"
#include "scene/materials/composites.h"
#include "scene/spectrum.h"

namespace caplet {

/// A diffuse base under a dielectric interface. Roughness has the meaning that it has in
/// ConductorMaterial.
struct CoatedDiffuseMaterial {
  Spectrum reflectance = ConstantSpectrum{0.5};
  Spectrum eta = ConstantSpectrum{1.5};
  double alpha_u = 0, alpha_v = 0;
  CoatLayer layer;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit.albedo({"reflectance", "reflectance of the base", 0, 1}, self.reflectance);
    visit.index({"eta", "index of refraction of the coat", 0}, self.eta);
    visit.roughness(surface_roughness, self.alpha_u, self.alpha_v);
    CoatLayer::fields(self.layer, visit);
  }
};

}  // namespace caplet
