// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <optional>

#include "scene/field.h"
#include "scene/media/scattering.h"
#include "scene/spectrum.h"

namespace caplet {

/// A medium with constant properties.
struct HomogeneousMedium {
  ScatteringProperties scattering;
  std::optional<Spectrum> radiance;  // emitted radiance per absorption
  double radiance_scale = 1;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit.scattering(self.scattering, milk);
    visit.emission({"Le", "radiance that it emits per absorption", 0}, self.radiance,
                   self.radiance_scale);
  }
  /// The default, as in pbrt-v4, is whole milk in millimetres.
  static ScatteringProperties milk() { return *named_scattering("Wholemilk"); }
};

}  // namespace caplet
