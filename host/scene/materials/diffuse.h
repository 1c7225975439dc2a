// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include "scene/field.h"
#include "scene/spectrum.h"

namespace caplet {

struct DiffuseMaterial {
  Spectrum reflectance = ConstantSpectrum{0.5};

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit.albedo({"reflectance", "share of the light that is reflected", 0, 1}, self.reflectance);
  }
};

}  // namespace caplet
