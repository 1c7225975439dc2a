// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "scene/field.h"
#include "scene/spectrum.h"

namespace caplet {

/// Absorption and scattering per world unit of length. scale: multiplies both coefficients. g: the
/// mean cosine of scattering (Henyey and Greenstein), -1 < g < 1.
struct ScatteringProperties {
  Spectrum sigma_a = ConstantSpectrum{1}, sigma_s = ConstantSpectrum{1};
  double scale = 1, g = 0;

  static constexpr double most_asymmetry = 0.999999;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit.unbounded({"sigma_a", "absorption per unit of length", 0}, self.sigma_a);
    visit.unbounded({"sigma_s", "scattering per unit of length", 0}, self.sigma_s);
    visit.number({"scale", "factor of both coefficients", 0}, self.scale);
    visit.asymmetry(self.g);
  }
};

inline constexpr Field asymmetry_field = {"g", "mean cosine of a scattering",
                                          -ScatteringProperties::most_asymmetry,
                                          ScatteringProperties::most_asymmetry};
inline constexpr Field scattering_preset_field = {
    "preset", "a measured stuff by its name, in place of sigma_a and sigma_s"};
inline constexpr Field radiance_scale_field = {"Lescale", "factor of what it emits", 0};

/// Both coefficients are 1 at all wavelengths.
inline ScatteringProperties unit_scattering() { return {}; }

/// Returns the absorption and reduced scattering of a measured medium per millimetre. The names are
/// pbrt-v4's; the values are from Jensen et al., "A practical model for subsurface light
/// transport", 2001 ("Skin1", "Marble"), and Narasimhan et al., "Acquiring scattering properties of
/// participating media by dilution", 2006 ("Espresso"). Unknown names have no value.
std::optional<ScatteringProperties> named_scattering(const std::string& name);
/// Lists all names that named_scattering knows.
std::vector<std::string> named_scattering_names();

}  // namespace caplet
