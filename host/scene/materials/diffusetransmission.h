// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <limits>

#include "scene/field.h"
#include "scene/spectrum.h"

namespace caplet {

/// Lambertian on both sides of a sheet. Reflectance and transmittance are multiplied by scale and
/// at most 1 each.
struct DiffuseTransmissionMaterial {
  Spectrum reflectance = ConstantSpectrum{0.25}, transmittance = ConstantSpectrum{0.25};
  double scale = 1;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit.albedo({"reflectance", "share of the light that is reflected", 0, 1}, self.reflectance);
    visit.albedo({"transmittance", "share of the light that is transmitted", 0, 1},
                 self.transmittance);
    visit.number({"scale", "factor of both", 0}, self.scale);
  }
};

}  // namespace caplet
