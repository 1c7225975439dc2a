// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <limits>

#include "scene/media/grid.h"
#include "scene/media/scattering.h"

namespace caplet {

/// A cloud of noise, thinner along +y of its space: coefficients are those of density 1.
struct CloudMedium {
  ScatteringProperties scattering;
  MediumBounds bounds;
  double density = 1, wispiness = 1, frequency = 5;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    constexpr double most = std::numeric_limits<double>::infinity();
    visit.scattering(self.scattering, unit_scattering);
    visit.bounds(self.bounds);
    visit.number("density", self.density, 0, most);
    visit.number("wispiness", self.wispiness, 0, most);
    visit.number("frequency", self.frequency, 0, most);
  }
};

}  // namespace caplet
