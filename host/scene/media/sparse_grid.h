// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <array>
#include <cstdint>
#include <glm/mat4x4.hpp>
#include <memory>
#include <string>
#include <vector>

#include "scene/bounds.h"

namespace caplet {

/// Values at whole voxel coordinates, linear between them; 0 where there is no brick. A brick is 8 x 8 x 8 voxels, x fastest.
struct SparseGrid {
  glm::dmat4 medium_from_voxels{1};
  Bounds box;                                       // in the medium's space
  std::vector<std::array<std::int32_t, 3>> bricks;  // of each the coordinates over 8, no two the same
  std::vector<float> values;                        // 512 a brick
  std::string file = {};                            // that it was read from
};
using SparseGridPointer = std::shared_ptr<const SparseGrid>;

/// Bricks between the least and the greatest that a grid may span: a table of them is made.
inline constexpr std::uint64_t most_spanned_bricks = std::uint64_t{1} << 27;

}  // namespace caplet
