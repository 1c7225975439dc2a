// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include "scene/field.h"
#include "scene/texture_operand.h"

namespace caplet {

/// The square root of a texture: it remaps a roughness to GGX's alpha.
struct RootTexture {
  TextureOperand tex = 0;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit.only(true);
    visit.operand({"tex", "value whose square root is taken"}, self.tex);
  }
};

}  // namespace caplet
