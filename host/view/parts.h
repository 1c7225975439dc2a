// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Parts of a scene that have a form, and messages about them.
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

/// A material, texture or light by its index in the scene; the emission or the geometry of a shape
/// of the world, by the shape's number; or a setting.
struct FormSubject {
  enum class Kind {
    material,
    texture,
    light,
    emission,
    shape,
    camera,
    film,
    filter,
    sampler,
    integrator
  };
  Kind kind = Kind::material;
  std::uint32_t number = 0;
};
inline constexpr std::array form_subject_names = {"material", "texture",   "light", "emission",
                                                  "shape",    "camera",    "film",  "filter",
                                                  "sampler",  "integrator"};

/// A texture that replaces a value, by its index.
struct TextureChoice {
  std::uint32_t texture = 0;
};
/// The new value of a field. The first alternative clears an optional field.
using Value = std::variant<std::monostate, double, bool, std::string, std::vector<double>, Spectrum,
                           TextureChoice>;

/// Sets a field of a part's form.
struct Set {
  FormSubject part;
  std::string field;
  Value to;
};
/// Adds a material, texture, light or shape of the world.
struct Add {
  FormSubject::Kind what = FormSubject::Kind::shape;
  std::string kind;                        // as in the list of its kind
  std::optional<std::uint32_t> like = {};  // a material to copy instead
  glm::dvec3 at{0}, towards{0, 0, -1};     // place of lights and shapes; direction of lights
  double size = 1;  // half the greatest extent of a shape; the distance that a light illuminates
  std::uint32_t material = 0;  // for shapes
  bool is_float = false;       // for textures
};
/// Removes a light.
struct Remove {
  FormSubject part;
};
/// Hides things from the picture and from rays, or (`others`) all things but these.
struct Hide {
  std::vector<std::uint32_t> ids;
  bool others = false;
};
/// Shows a hidden thing by its index in the list, or all of them.
struct Show {
  std::optional<std::uint32_t> hidden = {};
};

using FormChange = std::variant<Set, Add, Remove, Hide, Show>;

/// The most things that one change may name.
inline constexpr std::size_t most_chosen = 10000;

/// Asks for the form of a part.
struct Form {
  double number = 0;  // returned with the answer
  FormSubject part;
};

}  // namespace caplet::view
