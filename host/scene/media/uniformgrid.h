// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <limits>
#include <optional>

#include "scene/field.h"
#include "scene/media/grid.h"
#include "scene/media/scattering.h"
#include "scene/spectrum.h"

namespace caplet {

/// A medium with a density per cell; the coefficients apply at density 1. It emits `radiance` per
/// absorption, or a black body's at temperaturescale (temperature - temperatureoffset) kelvin,
/// times `radiance_scale`.
struct UniformGridMedium {
  ScatteringProperties scattering;
  MediumBounds bounds;
  GridCounts counts{1, 1, 1};
  FloatGrid density, radiance_scale, temperature;
  std::optional<Spectrum> radiance;
  double temperature_scale = 1, temperature_offset = 0;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit.scattering(self.scattering, unit_scattering);
    visit.bounds(self.bounds);
    visit.counts(self.counts);
    visit.grid({"density", "densities of the cells, x fastest", 0}, self.density, self.counts,
               true);
    visit.emission({"Le", "radiance that it emits per absorption", 0}, self.radiance);
    visit.grid({"Lescale", "factor of what each cell emits", 0}, self.radiance_scale, self.counts,
               false);
    visit.grid({"temperature", "temperatures of the cells", 0, no_limit, "kelvin"},
               self.temperature, self.counts, false);
    visit.number({"temperaturescale", "factor of the temperatures"}, self.temperature_scale);
    visit.number({"temperatureoffset", "kelvin that temperatures are lowered by"},
                 self.temperature_offset);
    visit.heat(self.radiance, self.temperature);
  }
};

}  // namespace caplet
