// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include "scene/field.h"
#include "scene/texture_mapping.h"
#include "scene/texture_operand.h"

namespace caplet {

/// Places disks at random in the unit squares of (s, t).
struct DotsTexture {
  TextureOperand inside = 1, outside = 0;
  TextureMapping mapping = {};

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit.operand({"inside", "value inside the dots"}, self.inside);
    visit.operand({"outside", "value outside the dots"}, self.outside);
    visit.mapping(self.mapping);
  }
};

}  // namespace caplet
