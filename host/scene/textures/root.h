// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include "scene/texture_operand.h"

namespace caplet {

/// The square root: GGX's alpha of a roughness that is remapped.
struct RootTexture {
  TextureOperand tex = 0;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit.only(true);
    visit.operand("tex", self.tex);
  }
};

}  // namespace caplet
