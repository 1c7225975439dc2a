// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <optional>
#include <string>

#include "base/error.h"
#include "scene/media/sparse_grid.h"

namespace caplet {

/// Reads the named grid of a NanoVDB file: 32-bit floats, uncompressed or compressed by ZIP.
/// Returns null when no grid has the name. Throws InputError at `where` for a file that cannot be
/// read.
SparseGridPointer read_nanovdb(const std::string& file, const std::string& grid,
                               const SourceLocation& where);

}  // namespace caplet
