// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <glm/mat4x4.hpp>

#include "scene/field.h"

namespace caplet {

/// A sum of octaves of noise, each `roughness` times as strong as the last.
struct FbmTexture {
  int octaves = 8;
  double roughness = 0.5;
  glm::dmat4 texture_from_world{1};

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit.only(true);
    visit.integer({"octaves", "octaves of noise", 0, 64}, self.octaves);
    visit.number({"roughness", "height of each octave relative to the last"}, self.roughness);
    visit.place(self.texture_from_world);
  }
};

}  // namespace caplet
