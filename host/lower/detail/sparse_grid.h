// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Grids of bricks as devices have them (kernels/media/nanovdb.cl).
#pragma once

#include <vector>

#include "scene/media/sparse_grid.h"

namespace caplet {

/// The head, the table of bricks, and their values.
std::vector<float> sparse_floats(const SparseGrid& grid, const glm::dmat4& world_from_medium);

/// Of CAPLET_SPARSE_MAJORANT_CELLS^3 cells of the grid's box, x fastest, the most that its values can be within.
std::vector<float> sparse_majorants(const SparseGrid& grid);

}  // namespace caplet
