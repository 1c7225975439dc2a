// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <optional>

#include "scene/field.h"
#include "scene/media/scattering.h"
#include "scene/spectrum.h"

namespace caplet {

/// The same everywhere.
struct HomogeneousMedium {
  ScatteringProperties scattering;
  std::optional<Spectrum> radiance;  // that it emits per absorption
  double radiance_scale = 1;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit.scattering(self.scattering, milk);
    visit.emission({"Le", "radiance that it emits per absorption", 0}, self.radiance, self.radiance_scale);
  }
  /// What has no parameters: a glass of milk in millimetres, as pbrt-v4 has it.
  static ScatteringProperties milk() { return *named_scattering("Wholemilk"); }
};

}  // namespace caplet
