// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <array>
#include <cstdint>

namespace caplet {

/// Now one material, now the other: the second with the probability `amount`. They are indices into Scene::materials, and a mix
/// may be of mixes but not of itself.
struct MixMaterial {
  std::array<std::uint32_t, 2> materials = {};
  double amount = 0.5;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit.parts(self.materials);
    visit.number("amount", self.amount, 0, 1);
  }
};

}  // namespace caplet
