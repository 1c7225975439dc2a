// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Textures (textures.def).
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "base/error.h"
#include "scene/textures.def"

namespace caplet {

template <class, class... Types>
using TextureVariant = std::variant<Types...>;

/// A texture of floats or of spectra.
struct Texture {
#define TEXTURE_MODEL(name, Type) , Type
  TextureVariant<void
#include "scene/textures.def"
                 >
      model;
  bool is_float = false;
  std::string name;
  SourceLocation where;
};

/// A parameter that a texture replaces: the field's name in kernels/shared/materials.def (also
/// "reflectance" of a metal), with the dots of scene files ("interface.alpha_u"), and the index
/// into Scene::textures.
struct TexturedField {
  std::string field;
  std::uint32_t texture = 0;
};

/// Returns the images of textures, each once, in the order of first use.
std::vector<const TextureImage*> images_of(const std::vector<Texture>& textures);

/// The most textures and constants that a texture may consist of, including itself.
inline constexpr std::size_t most_texture_steps = 31;

/// Counts the textures and constants that a texture consists of; one that occurs several times
/// counts once. A result above most_texture_steps only means that there are more. Operands must
/// precede the textures that use them.
std::size_t texture_steps(const std::vector<Texture>& textures, std::uint32_t texture);

}  // namespace caplet
