// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <limits>

#include "scene/field.h"
#include "scene/media/grid.h"
#include "scene/media/scattering.h"

namespace caplet {

/// A procedural cloud that thins along +y of its space. The coefficients apply at density 1.
struct CloudMedium {
  ScatteringProperties scattering;
  MediumBounds bounds;
  double density = 1, wispiness = 1, frequency = 5;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit.scattering(self.scattering, unit_scattering);
    visit.bounds(self.bounds);
    visit.number({"density", "density of the cloud's bulk", 0}, self.density);
    visit.number({"wispiness", "how far noise moves the cloud's edges", 0}, self.wispiness);
    visit.number({"frequency", "frequency of the noise", 0}, self.frequency);
  }
};

}  // namespace caplet
