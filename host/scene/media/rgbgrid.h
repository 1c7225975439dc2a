// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <limits>

#include "scene/media/grid.h"
#include "scene/media/scattering.h"

namespace caplet {

/// Coefficients of any colour in each cell; of those that are not given, 1. `scale` is of both, `radiance_scale` of what it emits
/// per absorption.
struct RgbGridMedium {
  double scale = 1, g = 0;
  MediumBounds bounds;
  GridCounts counts{1, 1, 1};
  ColorGrid sigma_a, sigma_s, radiance;
  double radiance_scale = 1;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    constexpr double most = std::numeric_limits<double>::infinity();
    visit.number("scale", self.scale, 0, most);
    visit.asymmetry(self.g);
    visit.bounds(self.bounds);
    visit.counts(self.counts);
    visit.colors("sigma_a", self.sigma_a, self.counts);
    visit.colors("sigma_s", self.sigma_s, self.counts);
    visit.colors("Le", self.radiance, self.counts);
    visit.number("Lescale", self.radiance_scale, 0, most);
    visit.any_of(self.sigma_a, self.sigma_s, self.radiance);
  }
};

}  // namespace caplet
