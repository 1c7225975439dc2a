// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <glm/mat4x4.hpp>

namespace caplet {

/// Likewise, of its magnitude.
struct WrinkledTexture {
  int octaves = 8;
  double roughness = 0.5;
  glm::dmat4 texture_from_world{1};

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit.only(true);
    visit.count("octaves", self.octaves, 0, 64);
    visit.number("roughness", self.roughness);
    visit.place(self.texture_from_world);
  }
};

}  // namespace caplet
