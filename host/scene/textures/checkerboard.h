// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include "scene/field.h"
#include "scene/texture_mapping.h"
#include "scene/texture_operand.h"

namespace caplet {

/// A pattern of unit squares of (s, t) or of unit cubes: tex1 where the sum of the integer parts is
/// even.
struct CheckerboardTexture {
  TextureOperand tex1 = 1, tex2 = 0;
  TextureMapping mapping = {};

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit.operand({"tex1", "value of the even squares"}, self.tex1);
    visit.operand({"tex2", "value of the odd squares"}, self.tex2);
    visit.board(self.mapping);
  }
};

}  // namespace caplet
