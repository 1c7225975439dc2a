// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <glm/mat4x4.hpp>

namespace caplet {

/// Layers along y of the point times `scale`, moved by `variation` times octaves of noise.
struct MarbleTexture {
  int octaves = 8;
  double roughness = 0.5, scale = 1, variation = 0.2;
  glm::dmat4 texture_from_world{1};

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit.only(false);
    visit.count("octaves", self.octaves, 0, 64);
    visit.number("roughness", self.roughness);
    visit.number("scale", self.scale);
    visit.number("variation", self.variation);
    visit.colors();
    visit.place(self.texture_from_world);
  }
};

}  // namespace caplet
