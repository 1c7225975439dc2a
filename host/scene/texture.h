// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// What varies over a surface (textures.def).
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

/// Floats or spectra over a surface.
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

/// A parameter that is a texture: the field by its name in kernels/shared/materials.def ("reflectance" of a metal too) with the
/// dots of scene files ("interface.alpha_u"), and the index into Scene::textures.
struct TexturedField {
  std::string field;
  std::uint32_t texture = 0;
};

/// The images of textures, each once, in the order in which they are named first.
std::vector<const TextureImage*> images_of(const std::vector<Texture>& textures);

/// The most textures and constants that a texture may consist of, itself among them.
inline constexpr std::size_t most_texture_steps = 31;

/// How many they are: of textures that come in more than once, each counts once. Above most_texture_steps: more than that.
/// Operands must be textures that come before.
std::size_t texture_steps(const std::vector<Texture>& textures, std::uint32_t texture);

}  // namespace caplet
