// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <glm/vec3.hpp>

#include "scene/field.h"
#include "scene/texture_operand.h"

namespace caplet {

/// amount tex1 + (1 - amount) tex2, where amount is the absolute cosine between the surface's
/// normal and `dir`.
struct DirectionmixTexture {
  TextureOperand tex1 = 0, tex2 = 1;
  glm::dvec3 dir{0, 1, 0};  // world, unit

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit.operand({"tex1", "value where the normal lies along dir"}, self.tex1);
    visit.operand({"tex2", "value where the normal is across dir"}, self.tex2);
    visit.direction({"dir", "direction in texture space"}, self.dir);
  }
};

}  // namespace caplet
