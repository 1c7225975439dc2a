// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include "scene/field.h"
#include "scene/texture_operand.h"

namespace caplet {

/// (1 - amount) tex1 + amount tex2.
struct MixTexture {
  TextureOperand tex1 = 0, tex2 = 1, amount = 0.5;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit.operand({"tex1", "value where amount is 0"}, self.tex1);
    visit.operand({"tex2", "value where amount is 1"}, self.tex2);
    visit.factor({"amount", "share of tex2"}, self.amount);
  }
};

}  // namespace caplet
