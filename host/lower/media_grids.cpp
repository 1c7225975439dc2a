// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "lower/detail/media_grids.h"

#include <algorithm>
#include <cmath>

#include "lower/color.h"
#include "lower/detail/sparse_grid.h"
#include "shared/limits.h"

namespace caplet {

namespace {

constexpr int majorant_cells = CAPLET_MAJORANT_CELLS;

/// Returns the greatest of `values` in each of the cells of the box: linear interpolation between
/// centres reaches those around it.
std::vector<float> most_within(const GridCounts& counts, const std::vector<float>& values) {
  const auto range = [&](std::size_t axis, int cell) {
    const double n = counts[axis];
    // A hundredth of a cell is added, for points that are rounded.
    const int low = static_cast<int>(std::floor(n * cell / majorant_cells - 0.51)),
              high = static_cast<int>(std::floor(n * (cell + 1) / majorant_cells - 0.49)) + 1;
    return std::pair(std::clamp(low, 0, counts[axis] - 1), std::clamp(high, 0, counts[axis] - 1));
  };
  std::vector<float> out;
  out.reserve(static_cast<std::size_t>(majorant_cells * majorant_cells * majorant_cells));
  for (int z = 0; z < majorant_cells; ++z)
    for (int y = 0; y < majorant_cells; ++y)
      for (int x = 0; x < majorant_cells; ++x) {
        const auto [x0, x1] = range(0, x);
        const auto [y0, y1] = range(1, y);
        const auto [z0, z1] = range(2, z);
        float most = 0;
        for (int k = z0; k <= z1; ++k)
          for (int j = y0; j <= y1; ++j) {
            const auto row = values.begin() + (std::ptrdiff_t{k} * counts[1] + j) * counts[0];
            most = std::max(most, *std::max_element(row + x0, row + x1 + 1));
          }
        out.push_back(most);
      }
  return out;
}

/// Returns the greatest value of a sigmoid spectrum at any wavelength in range.
float most_of(const float* texel) {
  double most = -1e9;
  const auto at = [&](double l) {
    most = std::max(most, (texel[0] * l + texel[1]) * l + texel[2]);
  };
  at(double{CAPLET_LAMBDA_MIN});
  at(double{CAPLET_LAMBDA_MAX});
  if (const double vertex = -texel[1] / (2.0 * texel[0]);
      vertex > double{CAPLET_LAMBDA_MIN} && vertex < double{CAPLET_LAMBDA_MAX})
    at(vertex);
  const double sigmoid = 0.5 + 0.5 * most / std::sqrt(1 + most * most);
  return static_cast<float>(texel[3] * std::min(1.0, sigmoid + 1e-4));
}

void add_most(const ColorGrid& grid, std::vector<float>& to) {
  if (!grid.rgb) {
    for (float& value : to) value += 1;
    return;
  }
  const std::vector<float> texels = grid_spectra(grid);
  for (std::size_t i = 0; i < to.size(); ++i) to[i] += most_of(&texels[4 * i]);
}

}  // namespace

std::vector<float> grid_spectra(const ColorGrid& grid) {
  std::vector<float> out;
  out.reserve(grid.rgb->size() / 3 * 4);
  for (std::size_t i = 0; i < grid.rgb->size(); i += 3) {
    const float* rgb = &(*grid.rgb)[i];
    const std::array<float, 4> texel =
        environment_texel(glm::dvec3(rgb[0], rgb[1], rgb[2]), grid.space);
    out.insert(out.end(), texel.begin(), texel.end());
  }
  return out;
}

std::vector<float> medium_majorants(const UniformGridMedium& medium) {
  return most_within(medium.counts, *medium.density);
}

std::vector<float> medium_majorants(const RgbGridMedium& medium) {
  std::vector<float> both(cells_of(medium.counts));
  add_most(medium.sigma_a, both);
  add_most(medium.sigma_s, both);
  return most_within(medium.counts, both);
}

std::vector<float> medium_majorants(const CloudMedium&) { return {1}; }

std::vector<float> medium_majorants(const NanovdbMedium& medium) {
  return sparse_majorants(*medium.density);
}

}  // namespace caplet
