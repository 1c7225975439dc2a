// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <limits>

#include "scene/field.h"
#include "scene/spectrum.h"

namespace caplet {

/// The layer between a coat's interface and the base, and the random walk through it.
struct CoatLayer {
  double thickness = 0.01;  // in mean free paths: extinction is 1 per unit
  Spectrum albedo =
      ConstantSpectrum{0};  // of single scattering; 0: the layer absorbs and does not scatter
  double g = 0;             // Henyey and Greenstein's asymmetry, -1 < g < 1
  int max_depth = 10;       // the most scattering events of a walk
  int samples = 1;          // the number of walks that are averaged

  static constexpr double most_asymmetry = 0.999999;
  static constexpr int most_walks = 10000;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit.number({"thickness", "thickness of the coat in mean free paths", 0}, self.thickness);
    visit.albedo({"albedo", "albedo of scattering within the coat", 0, 1}, self.albedo);
    visit.number(
        {"g", "mean cosine of a scattering within the coat", -most_asymmetry, most_asymmetry},
        self.g);
    visit.integer({"maxdepth", "most events of a walk between coat and base", 0, most_walks},
                  self.max_depth);
    visit.integer({"nsamples", "walks whose mean is a value", 1, most_walks}, self.samples);
  }
};

}  // namespace caplet
