// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <limits>

#include "scene/field.h"
#include "scene/media/scattering.h"
#include "scene/media/sparse_grid.h"

namespace caplet {

/// A medium with a sparse density grid. Where a temperature grid exists, it emits as
/// UniformGridMedium does.
struct NanovdbMedium {
  ScatteringProperties scattering;
  SparseGridPointer density, temperature;
  glm::dmat4 world_from_medium{1};
  double radiance_scale = 1, temperature_scale = 1, temperature_offset = 0;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit.scattering(self.scattering, unit_scattering);
    visit.volume(self.density, self.temperature, self.world_from_medium);
    visit.number(radiance_scale_field, self.radiance_scale);
    visit.number({"temperaturescale", "factor of the temperatures"}, self.temperature_scale);
    visit.number({"temperatureoffset", "kelvin that temperatures are lowered by"},
                 self.temperature_offset);
  }
};

}  // namespace caplet
