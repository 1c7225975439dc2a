// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <glm/mat4x4.hpp>

namespace caplet {

/// Imitates the waves of wind on water.
struct WindyTexture {
  glm::dmat4 texture_from_world{1};

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit.only(true);
    visit.place(self.texture_from_world);
  }
};

}  // namespace caplet
