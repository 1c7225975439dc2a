// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// What kernels/shared lists, as names and numbers: tests that run over a list have a new row on
// trial at once. The one place where tests expand shapes.def.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <ostream>
#include <span>
#include <string>

#include "shared/shapes.h"

namespace caplet::test {

/// A row of a list.
struct Kind {
  int number;
  const char* name;
};
inline void PrintTo(const Kind& kind, std::ostream* out) { *out << kind.name; }

/// Every row of shapes.def.
inline constexpr std::array<Kind, shape_count> all_shapes = {{
#define SHAPE(name, ...) {shape_##name, #name},
#include "shared/shapes.def"
#undef SHAPE
}};
inline constexpr std::array<Kind, material_count> all_materials = {{
#define MATERIAL(name, ...) {material_##name, #name},
#include "shared/materials.def"
#undef MATERIAL
}};
inline constexpr std::array<Kind, light_count> all_lights = {{
#define LIGHT(name, ...) {light_##name, #name},
#include "shared/lights.def"
#undef LIGHT
}};

/// A kind of shape, as the shape tests take it.
struct ShapeKind {
  int shape;
  const char* name;
};
inline void PrintTo(const ShapeKind& kind, std::ostream* out) { *out << kind.name; }

inline constexpr std::size_t hit_count =
    shape_count - 1 - std::popcount(shapes_with(trait_moves | trait_linked));
inline constexpr std::array<ShapeKind, hit_count> shapes_to_hit = [] {
  std::array<ShapeKind, hit_count> out{};
  std::size_t count = 0;
  for (const Kind& kind : all_shapes)
    if (kind.number != shape_instance &&
        !shape_has(static_cast<std::uint32_t>(kind.number), trait_moves | trait_linked))
      out[count++] = {kind.number, kind.name};
  return out;
}();
/// The shapes that a ray can hit: all but instances, which hold others, those that move, which
/// tests/motion compares with what they are at one time, and linked capsules, which tests/links
/// compares with the same unlinked.
inline std::span<const ShapeKind> shape_kinds() { return shapes_to_hit; }

/// As the name of a test that has a kind for its parameter.
inline constexpr auto name_of_kind = [](const auto& test) { return std::string(test.param.name); };

}  // namespace caplet::test
