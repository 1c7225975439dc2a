// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <array>
#include <cstdint>

#include "scene/field.h"

namespace caplet {

/// Chooses one of two materials at random: the second with the probability `amount`. Both are
/// indices into Scene::materials. A mix may contain other mixes but not itself.
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
