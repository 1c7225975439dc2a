// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <glm/mat4x4.hpp>

#include "scene/field.h"

namespace caplet {

/// Layers along y of the point times `scale`, displaced by `variation` times octaves of noise.
struct MarbleTexture {
  int octaves = 8;
  double roughness = 0.5, scale = 1, variation = 0.2;
  glm::dmat4 texture_from_world{1};

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit.only(false);
    visit.integer({"octaves", "octaves of noise", 0, 64}, self.octaves);
    visit.number({"roughness", "height of each octave relative to the last"}, self.roughness);
    visit.number({"scale", "factor of the point"}, self.scale);
    visit.number({"variation", "how far noise moves the layers"}, self.variation);
    visit.colors();
    visit.place(self.texture_from_world);
  }
};

}  // namespace caplet
