// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Puts the files that a kernel text includes into it, so that one string is the whole program and
// no include path is needed.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "device/row_masks.h"

namespace caplet {

/// Returns the text of the file of that path (from kernels/), or nothing when there is none.
using FileReader = std::function<std::optional<std::string>(const std::string& path)>;

/// Replaces every `#include "path"` line of `text` by the flattened text of that file, as often as
/// it is named; files with an include guard (their first directives are #ifndef NAME, #define NAME)
/// once, as their guard would have it. `#line` marks name `label` and "kernels/path", so build logs
/// point at the files. Angle includes stay; quoted includes under `#ifdef __cplusplus` become empty
/// lines.
///
/// Two kinds of paths stand for the rows of a list of shared/ that `rows` has:
///   "shapes/{shapes}.cl"   for every row of shared/shapes.def the file with its name in place of
///                          {shapes}: shapes/capsule.cl. Rows that begin with COMPOUND have none
///   "rows/shapes.def"      shared/shapes.def itself without the other rows
/// A row is a line that begins with a name in capitals and a bracket; FIELD, KEPT and names that
/// end in _END continue it. For each list of `rows` that the text names (CAPLET_SHAPES), its mask
/// is defined above everything else.
///
/// Throws std::logic_error with the place for a file that does not exist, a malformed include, a
/// list of more than 64 rows, and files that include each other in a circle.
std::string flatten(const std::string& text, const std::string& label, const FileReader& read,
                    const RowMasks& rows = {});

}  // namespace caplet
