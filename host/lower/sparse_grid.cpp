// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "lower/detail/sparse_grid.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/matrix.hpp>

#include "base/check.h"
#include "shared/kinds.h"
#include "shared/limits.h"

namespace caplet {

namespace {

constexpr std::size_t head = 20;  // kernels/media/nanovdb.cl
constexpr int sparse_majorant_cells = CAPLET_SPARSE_MAJORANT_CELLS;

float bits(std::uint32_t x) { return std::bit_cast<float>(x); }

}  // namespace

std::vector<float> sparse_floats(const SparseGrid& grid, const glm::dmat4& world_from_medium) {
  std::array<std::int32_t, 3> low{}, high{};
  for (std::size_t k = 0; k < 3 && !grid.bricks.empty(); ++k) {
    const auto by = [&](const auto& a, const auto& b) { return a[k] < b[k]; };
    low[k] = (*std::ranges::min_element(grid.bricks, by))[k];
    high[k] = (*std::ranges::max_element(grid.bricks, by))[k] + 1;
  }
  std::array<std::size_t, 3> count;
  for (std::size_t k = 0; k < 3; ++k)
    count[k] = static_cast<std::size_t>(std::int64_t{high[k]} - low[k]);
  const std::size_t table = count[0] * count[1] * count[2];
  std::vector<float> out(head + table, bits(CAPLET_NONE));
  const glm::dmat4 m = glm::inverse(world_from_medium * grid.medium_from_voxels);
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 4; ++c)
      out[static_cast<std::size_t>(4 * r + c)] = static_cast<float>(m[c][r]);
  for (std::size_t k = 0; k < 3; ++k) {
    out[12 + k] = bits(static_cast<std::uint32_t>(low[k]));
    out[15 + k] = bits(narrow<std::uint32_t>(count[k]));
  }
  out[18] = bits(narrow<std::uint32_t>(out.size()));
  out[19] = 0;
  for (std::size_t i = 0; i < grid.bricks.size(); ++i) {
    std::array<std::size_t, 3> at;
    for (std::size_t k = 0; k < 3; ++k)
      at[k] = static_cast<std::size_t>(std::int64_t{grid.bricks[i][k]} - low[k]);
    out[head + (at[2] * count[1] + at[1]) * count[0] + at[0]] = bits(narrow<std::uint32_t>(i));
  }
  out.insert(out.end(), grid.values.begin(), grid.values.end());
  return out;
}

std::vector<float> sparse_majorants(const SparseGrid& grid) {
  std::vector<float> out(static_cast<std::size_t>(sparse_majorant_cells) * sparse_majorant_cells *
                         sparse_majorant_cells);
  const glm::dvec3 extent = grid.box.max - grid.box.min;
  const glm::dmat4 cells_from_voxels =
      glm::scale(glm::dmat4(1), double{sparse_majorant_cells} / extent) *
      glm::translate(glm::dmat4(1), -grid.box.min) * grid.medium_from_voxels;
  // This is how far a voxel reaches, one to each side, in cells; a thousandth more, for points that
  // are rounded.
  glm::dvec3 reach(1e-3);
  for (int c = 0; c < 3; ++c) reach += glm::abs(glm::dvec3(cells_from_voxels[c]));
  for (std::size_t i = 0; i < grid.bricks.size(); ++i)
    for (int v = 0; v < 512; ++v) {
      const float value = grid.values[512 * i + static_cast<std::size_t>(v)];
      if (!(value > 0)) continue;
      const glm::dvec3 voxel(8.0 * grid.bricks[i][0] + (v & 7),
                             8.0 * grid.bricks[i][1] + (v >> 3 & 7),
                             8.0 * grid.bricks[i][2] + (v >> 6));
      const glm::dvec3 at(cells_from_voxels * glm::dvec4(voxel, 1));
      const auto cell = [](double x) {
        return static_cast<int>(std::clamp(std::floor(x), 0.0, sparse_majorant_cells - 1.0));
      };
      for (int z = cell(at.z - reach.z); z <= cell(at.z + reach.z); ++z)
        for (int y = cell(at.y - reach.y); y <= cell(at.y + reach.y); ++y)
          for (int x = cell(at.x - reach.x); x <= cell(at.x + reach.x); ++x) {
            float& most = out[(static_cast<std::size_t>(z) * sparse_majorant_cells +
                               static_cast<std::size_t>(y)) *
                                  sparse_majorant_cells +
                              static_cast<std::size_t>(x)];
            most = std::max(most, value);
          }
    }
  return out;
}

}  // namespace caplet
