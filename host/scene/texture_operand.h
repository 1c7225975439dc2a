// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <cstdint>
#include <optional>

#include "scene/spectrum.h"

namespace caplet {

/// An operand of a texture: a constant, or another texture, which precedes it in Scene::textures.
struct TextureOperand {
  TextureOperand(double number) : value(ConstantSpectrum{number}) {}
  Spectrum value;                        // a ConstantSpectrum for a texture of floats
  std::optional<std::uint32_t> texture;  // replaces it
};

}  // namespace caplet
