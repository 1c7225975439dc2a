// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include "scene/field.h"
#include "scene/texture_operand.h"

namespace caplet {

/// The product of two textures.
struct ScaleTexture {
  TextureOperand tex = 1, scale = 1;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit.operand({"tex", "value"}, self.tex);
    visit.factor({"scale", "factor"}, self.scale);
  }
};

}  // namespace caplet
