// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Converts grids of bricks to the form of devices (kernels/media/nanovdb.cl).
#pragma once

#include <vector>

#include "scene/media/sparse_grid.h"

namespace caplet {

/// Returns the head, the table of bricks, and their values.
std::vector<float> sparse_floats(const SparseGrid& grid, const glm::dmat4& world_from_medium);

/// Returns for CAPLET_SPARSE_MAJORANT_CELLS^3 cells of the grid's box, x fastest, the greatest
/// value within each.
std::vector<float> sparse_majorants(const SparseGrid& grid);

}  // namespace caplet
