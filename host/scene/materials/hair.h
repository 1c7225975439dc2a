// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <optional>

#include "scene/field.h"
#include "scene/spectrum.h"

namespace caplet {

/// A fibre whose axis is along dp/dv (docs/materials.md). sigma_a: absorption per radius.
/// reflectance: the colour of many fibres together, which replaces sigma_a. beta_m, beta_n:
/// roughness along and around the fibre. alpha: tilt of the scales in degrees.
struct HairMaterial {
  Spectrum sigma_a = melanin(eumelanin, 0);
  std::optional<Spectrum> reflectance;
  double eta = 1.55;
  double beta_m = 0.3, beta_n = 0.3;
  double alpha = 2;

  static constexpr double eumelanin = 1.3;  // of brown hair
  /// Returns absorption per radius from pigment concentrations (Chiang et al. 2016; d'Eon et al.
  /// 2011), as sRGB components.
  static Spectrum melanin(double eumelanin, double pheomelanin) {
    return RgbSpectrum{
        eumelanin * glm::dvec3(0.419, 0.697, 1.37) + pheomelanin * glm::dvec3(0.187, 0.4, 1.05),
        ColorSpace::srgb};
  }

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit.pigment({{"sigma_a", "absorption per radius", 0},
                   {"reflectance", "colour that many fibres have together", 0, 1}},
                  self.sigma_a, self.reflectance);
    visit.number({"eta", "index of refraction inside", 1, 10}, self.eta);
    visit.number({"beta_m", "roughness along the fibre", 0, 1}, self.beta_m);
    visit.number({"beta_n", "roughness around the fibre", 0, 1}, self.beta_n);
    visit.number({"alpha", "tilt of the scales", -90, 90, "degrees"}, self.alpha);
  }
};

}  // namespace caplet
