// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "texture_trials.h"

#include <cmath>

#include "shared/kinds.h"

namespace caplet::test {

namespace {

/// Half at even squares of the unit grid, 0.125 at odd ones.
CheckerboardTexture board() {
  CheckerboardTexture checks;
  checks.tex1 = 0.5;
  checks.tex2 = 0.125;
  return checks;
}

Texture floats(decltype(Texture::model) model) { return {std::move(model), true, "t", {}}; }

}  // namespace

TextureOperand operand_of(std::uint32_t texture) {
  TextureOperand operand = 0;
  operand.texture = texture;
  return operand;
}

const std::vector<TextureOnTrial>& textures_on_trial() {
  static const std::vector<TextureOnTrial> all = {
#define TEXTURE(name) {texture_##name, #name, name##_texture_trial()},
#include "shared/textures.def"
#undef TEXTURE
  };
  return all;
}

// A constant is a step of what takes it: once 0.25.
TextureTrial constant_texture_trial() {
  ScaleTexture once;
  once.tex = 0.25;
  return {{floats(once)}, {{0.3, 0.7, 0.25}, {-5, 9, 0.25}}};
}

TextureTrial checkerboard_texture_trial() {
  CheckerboardTexture checks = board();
  checks.uscale = 4;
  checks.vscale = 2;
  checks.udelta = 0.5;
  checks.vdelta = -1;
  // (4 u + 0.5, 2 v - 1): whole parts and whether their sum is even.
  return {{floats(checks)},
          {{0, 0, 0.125},        // 0.5, -1: 0 - 1
           {0.2, 0.1, 0.5},      // 1.3, -0.8: 1 - 1
           {0.2, 0.6, 0.125},    // 1.3, 0.2: 1 + 0
           {0.125, 0.5, 0.125},  // 1, 0: the edge is the next square's
           {0.12, 0.5, 0.5},     // 0.98, 0
           {-0.2, 0.9, 0.125},   // -0.3, 0.8: -1 + 0
           {-0.4, 0.4, 0.125},   // -1.1, -0.2: -2 - 1
           {-0.2, 0.4, 0.5},     // -0.3, -0.2: -1 - 1
           {1000, 0.5, 0.5}}};   // 4000.5, 0
}

TextureTrial scale_texture_trial() {
  ScaleTexture product;
  product.tex = operand_of(0);
  product.scale = 0.75;
  return {{floats(board()), floats(product)}, {{0.5, 0.5, 0.375}, {1.5, 0.5, 0.09375}}};
}

TextureTrial mix_texture_trial() {
  // The amount varies as well: 0.25 and 1.
  CheckerboardTexture amount;
  amount.tex1 = 0.25;
  amount.tex2 = 1;
  amount.uscale = 2;
  MixTexture mixed;
  mixed.tex1 = operand_of(0);
  mixed.tex2 = 0.875;
  mixed.amount = operand_of(1);
  return {{floats(board()), floats(amount), floats(mixed)},
          {{0.2, 0.5, 0.59375},   // 0.75 of 0.5 and 0.25 of 0.875
           {0.7, 0.5, 0.875},     // all of the second
           {1.2, 0.5, 0.3125}}};  // 0.75 of 0.125 and 0.25 of 0.875
}

TextureTrial bilerp_texture_trial() {
  BilerpTexture square;
  square.v00 = 0.25;
  square.v01 = 0.5;
  square.v10 = 0.75;
  square.v11 = operand_of(0);  // 0.5 where it counts
  square.uscale = 2;
  square.vdelta = 0.25;
  return {{floats(board()), floats(square)},
          {{0, -0.25, 0.25},  // the corners
           {0, 0.75, 0.5},
           {0.5, -0.25, 0.75},
           {0.5, 0.75, 0.5},
           {0.25, 0.25, 0.5},        // the middle: their mean
           {0.125, 0.5, 0.46875}}};  // (0.25, 0.75): 0.75 (0.25 0.25 + 0.75 0.5) + 0.25 (0.25 0.75 + 0.75 0.5)
}

TextureTrial root_texture_trial() {
  RootTexture root;
  root.tex = operand_of(0);
  return {{floats(board()), floats(root)}, {{0.5, 0.5, std::sqrt(0.5)}, {1.5, 0.5, std::sqrt(0.125)}}};
}

// k of reflectances 0.5 and 0.125: 2 sqrt(r / (1 - r)).
TextureTrial extinction_texture_trial() {
  return {{floats(board())}, {{0.5, 0.5, 2}, {1.5, 0.5, 2 / std::sqrt(7)}}, 8 * 0x1p-24, "k"};
}

}  // namespace caplet::test
