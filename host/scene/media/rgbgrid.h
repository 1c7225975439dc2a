// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <limits>

#include "scene/field.h"
#include "scene/media/grid.h"
#include "scene/media/scattering.h"

namespace caplet {

/// A medium with coloured coefficients in each cell; coefficients that are not given are 1. `scale`
/// multiplies both coefficients, `radiance_scale` the emission per absorption.
struct RgbGridMedium {
  double scale = 1, g = 0;
  MediumBounds bounds;
  GridCounts counts{1, 1, 1};
  ColorGrid sigma_a, sigma_s, radiance;
  double radiance_scale = 1;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit.number({"scale", "factor of both coefficients", 0}, self.scale);
    visit.asymmetry(self.g);
    visit.bounds(self.bounds);
    visit.counts(self.counts);
    visit.grid({"sigma_a", "absorption of the cells, x fastest", 0}, self.sigma_a, self.counts);
    visit.grid({"sigma_s", "scattering of the cells, x fastest", 0}, self.sigma_s, self.counts);
    visit.grid({"Le", "radiance that the cells emit per absorption", 0}, self.radiance,
               self.counts);
    visit.number(radiance_scale_field, self.radiance_scale);
    visit.any_of(self.sigma_a, self.sigma_s, self.radiance);
  }
};

}  // namespace caplet
