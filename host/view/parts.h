// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Parts of a scene that have a form, and what is said of them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "scene/spectrum.h"

namespace caplet::view {

/// A material, texture or light by its index in the scene; what a shape of the world emits, or its geometry, by the shape's
/// number; or a setting.
struct Part {
  enum class Kind { material, texture, light, emission, shape, film, filter, sampler, integrator } kind = Kind::material;
  std::uint32_t number = 0;
};
inline constexpr std::array<const char*, 9> part_names = {"material", "texture", "light",   "emission",  "shape",
                                                          "film",     "filter",  "sampler", "integrator"};

/// A texture in place of a value, by its index.
struct TextureChoice {
  std::uint32_t texture = 0;
};
/// What a field is set to; the first: nothing, of a field that may have none.
using Value = std::variant<std::monostate, double, bool, std::string, std::vector<double>, Spectrum, TextureChoice>;

/// Sets a field of a part's form.
struct Set {
  Part part;
  std::string field;
  Value to;
};
/// A new material, texture, light or shape of the world.
struct Add {
  Part::Kind what = Part::Kind::shape;
  std::string kind;                        // as the list of its kind names it
  std::optional<std::uint32_t> like = {};  // a material that it is a copy of, instead
  glm::dvec3 at{0}, towards{0, 0, -1};     // of lights and shapes: where it is; of lights: where it shines
  double size = 1;                         // of shapes: half the greatest extent; of lights: how far it shines
  std::uint32_t material = 0;              // of shapes
  bool is_float = false;                   // of textures
};
/// Takes a light away.
struct Remove {
  Part part;
};
/// Leaves things out of the picture and of rays, or (`others`) all but these.
struct Hide {
  std::vector<std::uint32_t> ids;
  bool others = false;
};
/// Shows one of the hidden things by its place in their list, or all of them.
struct Show {
  std::optional<std::uint32_t> hidden = {};
};

using FormChange = std::variant<Set, Add, Remove, Hide, Show>;

/// Most things that one change may name.
inline constexpr std::size_t most_chosen = 10000;

/// What a part's form is.
struct Form {
  double number = 0;  // given back with the answer
  Part part;
};

}  // namespace caplet::view
