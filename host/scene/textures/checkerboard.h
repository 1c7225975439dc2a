// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include "scene/texture_operand.h"

namespace caplet {

/// Unit squares of (uscale u + udelta, vscale v + vdelta): tex1 where the sum of their whole parts is even.
struct CheckerboardTexture {
  TextureOperand tex1 = 1, tex2 = 0;
  double uscale = 1, vscale = 1, udelta = 0, vdelta = 0;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit.operand("tex1", self.tex1);
    visit.operand("tex2", self.tex2);
    visit.fixed("dimension", 2);
    visit.mapping(self.uscale, self.vscale, self.udelta, self.vdelta);
  }
};

}  // namespace caplet
