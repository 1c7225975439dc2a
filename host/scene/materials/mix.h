// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <array>
#include <cstdint>

#include "scene/field.h"

namespace caplet {

/// Now one material, now the other: the second with the probability `amount`. They are indices into Scene::materials, and a mix
/// may be of mixes but not of itself.
struct MixMaterial {
  std::array<std::uint32_t, 2> materials = {};
  double amount = 0.5;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit.parts({"materials", "names of the two materials"}, self.materials);
    visit.number({"amount", "probability of the second", 0, 1}, self.amount);
  }
};

}  // namespace caplet
