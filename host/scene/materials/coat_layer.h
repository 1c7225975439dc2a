// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <limits>

#include "scene/spectrum.h"

namespace caplet {

/// What lies between a coat's interface and the base, and how the walk through it is made.
struct CoatLayer {
  double thickness = 0.01;                // in mean free paths: extinction is 1 per unit
  Spectrum albedo = ConstantSpectrum{0};  // of single scattering; 0: the layer absorbs and does not scatter
  double g = 0;                           // Henyey and Greenstein's asymmetry, -1 < g < 1
  int max_depth = 10;                     // most events of a walk
  int samples = 1;                        // walks whose mean is a value

  static constexpr double most_asymmetry = 0.999999;
  static constexpr int most_walks = 10000;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit.number("thickness", self.thickness, 0, std::numeric_limits<double>::infinity());
    visit.albedo("albedo", self.albedo);
    visit.number("g", self.g, -most_asymmetry, most_asymmetry);
    visit.whole("maxdepth", self.max_depth, 0, most_walks);
    visit.whole("nsamples", self.samples, 1, most_walks);
  }
};

}  // namespace caplet
