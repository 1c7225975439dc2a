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

std::shared_ptr<const TextureImage> image_of(int width, int height, int channels,
                                             std::vector<float> values) {
  auto image = std::make_shared<TextureImage>();
  image->width = width;
  image->height = height;
  image->channels = channels;
  image->floats = std::move(values);
  return image;
}

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
  checks.mapping.uscale = 4;
  checks.mapping.vscale = 2;
  checks.mapping.udelta = 0.5;
  checks.mapping.vdelta = -1;
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
  amount.mapping.uscale = 2;
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
  square.mapping.uscale = 2;
  square.mapping.vdelta = 0.25;
  return {{floats(board()), floats(square)},
          {{0, -0.25, 0.25},  // the corners
           {0, 0.75, 0.5},
           {0.5, -0.25, 0.75},
           {0.5, 0.75, 0.5},
           {0.25, 0.25, 0.5},  // the middle: their mean
           {0.125, 0.5,
            0.46875}}};  // (0.25, 0.75): 0.75 (0.25 0.25 + 0.75 0.5) + 0.25 (0.25 0.75 + 0.75 0.5)
}

TextureTrial root_texture_trial() {
  RootTexture root;
  root.tex = operand_of(0);
  TextureTrial out{{floats(board()), floats(root)},
                   {{0.5, 0.5, std::sqrt(0.5)}, {1.5, 0.5, std::sqrt(0.125)}}};
  out.of_spectra = false;
  return out;
}

// k of reflectances 0.5 and 0.125: 2 sqrt(r / (1 - r)).
TextureTrial extinction_texture_trial() {
  return {{floats(board())}, {{0.5, 0.5, 2}, {1.5, 0.5, 2 / std::sqrt(7)}}, 8 * 0x1p-24, "k"};
}

namespace {

/// 2 x 2 texels of grey, as floats: 0.125 0.25 above 0.5 1.
std::shared_ptr<const TextureImage> four_texels() {
  auto image = std::make_shared<TextureImage>();
  image->width = image->height = 2;
  image->floats = {0.125f, 0.25f, 0.5f, 1};
  return image;
}

}  // namespace

TextureTrial imagemap_texture_trial() {
  ImagemapTexture map;
  map.image = four_texels();
  // Texel centres are at 1/4 and 3/4, the bottom row at t = 1/4.
  return {{floats(map)},
          {{0.25, 0.25, 0.5},
           {0.75, 0.25, 1},
           {0.25, 0.75, 0.125},
           {0.75, 0.75, 0.25},
           {0.5, 0.75, 0.1875},  // between two
           {0.5, 0.5, 0.46875},  // between four
           {0, 0.25, 0.75},      // between the first and the last: it repeats
           {-0.75, 5.25, 0.5},
           // Looks are over twice the sides: what is as wide, or as high, as both texels is their
           // mean, of all four.
           {0.25, 0.25, 0.46875, {}, {0, 0, 1}, {}, {}, {0.5f, 0}, {0, 0.01f}},
           {0.25, 0.25, 0.46875, {}, {0, 0, 1}, {}, {}, {0, 0.5f}, {0.01f, 0}},
           {0.25, 0.25, 0.46875, {}, {0, 0, 1}, {}, {}, {0, 0.01f}, {0.5f, 0}},
           {0.25, 0.25, 0.46875, {}, {0, 0, 1}, {}, {}, {0.01f, 0}, {0, 0.5f}},
           {0.25, 0.25, 0.5, {}, {0, 0, 1}, {}, {}, {0.24f, 0}, {0, 0.24f}}}};
}

// Amounts by the cosine of the normal and the direction: 0.6 (0.5) + 0.4 (0.125) and so on.
TextureTrial directionmix_texture_trial() {
  DirectionmixTexture mixed;
  mixed.tex1 = operand_of(0);
  mixed.tex2 = 0.125;
  mixed.dir = {0, 0.6, 0.8};
  return {{floats(board()), floats(mixed)},
          {{0.5, 0.5, 0.425},                 // 0.8 along z
           {0.5, 0.5, 0.35, {}, {0, -1, 0}},  // 0.6, whichever side
           {0.5, 0.5, 0.125, {}, {1, 0, 0}},
           {0.5, 0.5, 0.5, {}, {0, 0.6f, 0.8f}}}};
}

// Cells about (0, 1) and (3, 2) have a dot, those about (0, 0) and (1, 1) have none: by the noise
// at their corners, worked out apart, as is how far dots are moved: the dot about (5, 5) has its
// centre at (4.9993, 5.0013), that about (19, 37) is moved by
// (-0.09756, 0.10598), that about (10, 18) by (-0.09539, -0.06783), that about (-2, -5) by
// (-0.07636, 0.11315). Of these a point 0.345 away on each side is inside and one 0.355 away is
// not.
TextureTrial dots_texture_trial() {
  DotsTexture dots;
  dots.inside = 0.75;
  dots.outside = operand_of(0);
  dots.mapping.uscale = 2;
  return {{floats(board()), floats(dots)},
          {{0.01, 0.93, 0.75},           // (0.02, 0.93); the centre is (0.0256, 0.9342)
           {0.01, 0.601, 0.75},          // 0.333 below it
           {0.01, 0.565, 0.5},           // 0.369 below it, in the board's even square
           {0.05, 0.02, 0.5},            // no dot
           {0.5, 1.02, 0.125},           // none about (1, 1); the odd square
           {2.49, 5.345, 0.75},          // 0.344 above the centre
           {2.49, 5.36, 0.125},          // 0.359; (2.49, 5.36) is in an odd square
           {9.623721, 37.105984, 0.75},  // (18.902442 + 0.345, 37.105984)
           {9.628721, 37.105984, 0.5},   // 0.355; (9, 37)
           {9.278721, 37.105984, 0.75},
           {9.273721, 37.105984, 0.5},
           {9.451221, 37.450984, 0.75},
           {9.451221, 37.460984, 0.5},
           {9.451221, 36.760984, 0.75},
           {9.451221, 36.750984, 0.125},  // (9, 36)
           {5.124807, 17.932168, 0.75},   // (9.904614 + 0.345, 17.932168)
           {5.129807, 17.932168, 0.5},    // (5, 17)
           {4.952307, 18.277168, 0.75},
           {4.952307, 18.287168, 0.5},    // (4, 18)
           {-0.865680, -4.886848, 0.75},  // (-2.076361 + 0.345, -4.886848)
           {-0.860680, -4.886848, 0.5},   // (-1, -5)
           {-1.038180, -5.231848, 0.75},
           {-1.038180, -5.241848, 0.5}}};  // (-2, -6)
}

// Noise at three points by another program (Perlin's definition with pbrt-v4's gradients): its sum
// over one octave is itself.
TextureTrial fbm_texture_trial() {
  FbmTexture noise;
  noise.octaves = 3;
  return {{floats(noise)},
          {{0, 0, 0.193748207, {0.5f, 0.25f, -0.75f}},
           {0, 0, -0.0729523367, {3.2f, -1.7f, 9.4f}},
           {0, 0, 0.522669931, {-100.3f, 55.9f, 0.1f}},
           // A footprint of 1/8 shows the first two octaves.
           {0, 0, 0.196306593, {0.5f, 0.25f, -0.75f}, {0, 0, 1}, {0.125f, 0, 0}, {0, 0.0625f, 0}}},
          2e-5,
          "step",
          true,
          false};
}

TextureTrial wrinkled_texture_trial() {
  WrinkledTexture noise;
  noise.octaves = 2;
  noise.roughness = 0.25;
  return {{floats(noise)},
          {{0, 0, 0.180065289, {0.5f, 0.25f, -0.75f}},
           {0, 0, 0.283878626, {3.2f, -1.7f, 9.4f}},
           {0, 0, 0.266841748, {-100.3f, 55.9f, 0.1f}},
           // A footprint too wide for any octave shows the mean, 0.2 an octave; and once more, as
           // pbrt-v4 counts.
           {0, 0, 0.45, {0.5f, 0.25f, -0.75f}, {0, 0, 1}, {8, 0, 0}, {}}},
          2e-5,
          "step",
          true,
          false};
}

TextureTrial windy_texture_trial() {
  return {{floats(WindyTexture{})},
          {{0, 0, 0.0122798618, {0.5f, 0.25f, -0.75f}},
           {0, 0, -0.036941737, {3.2f, -1.7f, 9.4f}},
           {0, 0, 0.000626136523, {-100.3f, 55.9f, 0.1f}}},
          3e-3,  // products of sums that cancel
          "step",
          true,
          false};
}

// Greys nearly, by another program: (0.8520 0.8454 0.8477) and (0.8633 0.8633 0.8916).
TextureTrial marble_texture_trial() {
  MarbleTexture marble;
  marble.octaves = 2;
  marble.scale = 2;
  marble.variation = 0.5;
  return {{floats(marble)},
          {{0, 0, 0.8484, {3.2f, -1.7f, 9.4f}}, {0, 0, 0.8727, {-100.3f, 55.9f, 0.1f}}},
          0.03,
          "reflectance",
          false,
          true};
}

// (r, g, b) is (2 r - 1, 2 g - 1, 2 b - 1): here x.
TextureTrial normalmap_texture_trial() {
  auto image = std::make_shared<TextureImage>();
  image->width = 2;
  image->height = 1;
  image->channels = 3;
  image->floats = {0.75f, 0.5f, 1, 0.25f, 1, 0.5f};
  Texture map = floats(NormalmapTexture{image});
  return {{map},       {{0.25, 0.5, 0.5}, {0.75, 0.5, -0.5}, {0.375, 0.5, 0.25}},
          4 * 0x1p-24, "step",
          true,        false};
}

// Steps that lowering puts in after a texture.
TextureTrial displacement_texture_trial() {
  return {
      {floats(board())},   {{0.5, 0.5, 0.5}, {1.5, 0.5, 0.125}}, 4 * 0x1p-24, "step", true, false,
      texture_displacement};
}

TextureTrial alpha_texture_trial() {
  ScaleTexture wide;
  wide.tex = operand_of(0);
  wide.scale = 4;
  return {{floats(board()), floats(wide)},
          {{0.5, 0.5, 1}, {1.5, 0.5, 0.5}},
          4 * 0x1p-24,
          "step",
          true,
          false,
          texture_alpha};
}

}  // namespace caplet::test
