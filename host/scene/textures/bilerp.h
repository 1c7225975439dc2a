// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include "scene/field.h"
#include "scene/texture_mapping.h"
#include "scene/texture_operand.h"

namespace caplet {

/// Interpolates bilinearly in (s, t): v01 is at (0, 1), v10 at (1, 0).
struct BilerpTexture {
  TextureOperand v00 = 0, v01 = 1, v10 = 0, v11 = 1;
  TextureMapping mapping = {};

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit.operand({"v00", "value at (0, 0)"}, self.v00);
    visit.operand({"v01", "value at (0, 1)"}, self.v01);
    visit.operand({"v10", "value at (1, 0)"}, self.v10);
    visit.operand({"v11", "value at (1, 1)"}, self.v11);
    visit.mapping(self.mapping);
  }
};

}  // namespace caplet
