// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <optional>

#include "scene/materials/composites.h"
#include "scene/spectrum.h"

namespace caplet {

/// alpha_u, alpha_v: GGX roughness along dp/du and dp/dv after any remapping; both 0: perfectly
/// smooth. multiscatter: compensates for the energy that single scattering loses at rough facets
/// (Kulla and Conty 2017).
struct ConductorMaterial {
  Spectrum eta = copper_eta(), k = copper_k();
  std::optional<Spectrum> reflectance;  // at normal incidence, 0..1; replaces eta and k
  double alpha_u = 0, alpha_v = 0;
  bool multiscatter = false;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit.metal(plain_metal, self.eta, self.k, self.reflectance);
    visit.roughness(surface_roughness, self.alpha_u, self.alpha_v);
    visit.flag(multiscatter_field, self.multiscatter);
  }
};

}  // namespace caplet
