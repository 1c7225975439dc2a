// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <optional>
#include <string>

#include "base/error.h"
#include "scene/media/sparse_grid.h"

namespace caplet {

/// The grid of that name in a NanoVDB file: of 32-bit floats, uncompressed or by ZIP. Nothing where there is none of that name.
/// Throws InputError at `where` for a file that cannot be read.
SparseGridPointer read_nanovdb(const std::string& file, const std::string& grid, const SourceLocation& where);

}  // namespace caplet
