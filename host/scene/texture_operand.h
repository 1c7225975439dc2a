// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <cstdint>
#include <optional>

#include "scene/spectrum.h"

namespace caplet {

/// What a texture is made of: a constant, or another texture, which comes before it in Scene::textures.
struct TextureOperand {
  TextureOperand(double number) : value(ConstantSpectrum{number}) {}
  Spectrum value;                        // of a texture of floats, a ConstantSpectrum
  std::optional<std::uint32_t> texture;  // replaces it
};

}  // namespace caplet
