// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// What each texture of kernels/shared/textures.def brings to the tests that all of them pass: one
// function a texture, in texture_trials.cpp. A row of the list without its function does not link.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace caplet::test {

struct TextureTrial {
  /// At (u, v), or at a place, by hand.
  struct Value {
    double u, v, value;
    std::array<float, 3> p = {static_cast<float>(u), static_cast<float>(v), 0}, n = {0, 0, 1};
    std::array<float, 3> dpdx = {}, dpdy = {};    // the sides of what is seen
    std::array<float, 2> duvdx = {}, duvdy = {};  // along them
  };
  /// Textures of floats; the last is on trial. The test repeats the trial with spectra that are
  /// constant over wavelengths.
  std::vector<Texture> textures;
  std::vector<Value> values;
  double tolerance = 4 * 0x1p-24;  // relative: products, a sum and a root
  std::string field =
      "alpha_u";  // what of a material it is; "step": none, but the value of the steps of `last`
  bool of_floats = true, of_spectra = true;
  int last = -1;  // a step that lowering puts in
};

struct TextureOnTrial {
  int kind;
  std::string name;
  TextureTrial trial;
};
/// In the order of the list.
const std::vector<TextureOnTrial>& textures_on_trial();

#define TEXTURE(name) TextureTrial name##_texture_trial();
#include "shared/textures.def"
#undef TEXTURE

/// An image of floats of some channels.
std::shared_ptr<const TextureImage> image_of(int width, int height, int channels,
                                             std::vector<float> values);

/// A texture of the scene as an operand.
TextureOperand operand_of(std::uint32_t texture);

}  // namespace caplet::test
