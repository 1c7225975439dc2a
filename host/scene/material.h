// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Materials of surfaces (materials.def).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "base/error.h"
#include "scene/field.h"
#include "scene/materials.def"
#include "scene/texture.h"

namespace caplet {

template <class, class... Types>
using MaterialVariant = std::variant<Types...>;

struct Material {
#define MATERIAL_MODEL(name, Type) , Type
  MaterialVariant<void
#include "scene/materials.def"
                  >
      model;
  std::string name;
  SourceLocation where;
  std::vector<TexturedField> textures = {};  // fields that textures replace
  // Indices into Scene::textures; at most one is set: heights along the normal (floats), or a
  // NormalmapTexture.
  std::optional<std::uint32_t> displacement = {}, normalmap = {};
};

/// Describes a range in an error message: "must lie between", or "must be from ... up" where `high`
/// is infinite.
std::string must_lie_within(double low, double high);
/// Describes the range of a field, which may exclude `low`.
std::string must_lie_within(const Field& field);
/// Returns whether a value lies within the range of a field; NaN does not.
inline bool is_within(const Field& field, double value) {
  return (field.above_low ? value > field.low : value >= field.low) && value <= field.high;
}

/// Returns the index into Scene::textures of the texture that replaces the field.
inline std::optional<std::uint32_t> texture_of(const Material& material, std::string_view field) {
  for (const TexturedField& one : material.textures)
    if (one.field == field) return one.texture;
  return std::nullopt;
}

}  // namespace caplet
