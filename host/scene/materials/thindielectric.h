// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include "scene/field.h"
#include "scene/spectrum.h"

namespace caplet {

/// A pane too thin to bend light or to be seen from the side.
struct ThinDielectricMaterial {
  Spectrum eta = ConstantSpectrum{1.5};

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit.index({"eta", "index of refraction of the pane", 0}, self.eta);
  }
};

}  // namespace caplet
