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

/// Values at integer voxel coordinates, linear between them; 0 where there is no brick. A brick is
/// 8 x 8 x 8 voxels, x fastest.
struct SparseGrid {
  glm::dmat4 medium_from_voxels{1};
  Bounds box;  // in the medium's space
  std::vector<std::array<std::int32_t, 3>>
      bricks;                 // coordinates of each brick divided by 8, all distinct
  std::vector<float> values;  // 512 per brick
  std::string file = {};      // the file that it was read from
};
using SparseGridPointer = std::shared_ptr<const SparseGrid>;

/// The most bricks that the range of a grid's brick coordinates may span: a table of them is
/// allocated.
inline constexpr std::uint64_t most_spanned_bricks = std::uint64_t{1} << 27;

}  // namespace caplet
