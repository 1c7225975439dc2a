// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <array>
#include <cstddef>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <vector>

#include "scene/spectrum.h"

namespace caplet {

/// The box that a medium fills, from p0 to p1 in its own space.
struct MediumBounds {
  glm::dvec3 p0{0}, p1{1};
  glm::dmat4 world_from_medium{1};
};

/// The number of cells along x, y and z.
using GridCounts = std::array<int, 3>;
/// These are the names in scene files.
inline constexpr std::array grid_count_names = {"nx", "ny", "nz"};

inline std::size_t cells_of(const GridCounts& counts) {
  return static_cast<std::size_t>(counts[0]) * static_cast<std::size_t>(counts[1]) *
         static_cast<std::size_t>(counts[2]);
}
/// The most cells of a grid: 32-bit indices reach four floats of each.
inline constexpr std::size_t most_grid_cells = std::size_t{1} << 28;

/// One value per cell, x fastest; null: there is none.
using FloatGrid = std::shared_ptr<const std::vector<float>>;
/// Three values per cell: colours in one space.
struct ColorGrid {
  FloatGrid rgb;
  ColorSpace space = ColorSpace::srgb;
};

}  // namespace caplet
