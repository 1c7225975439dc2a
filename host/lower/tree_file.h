// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// A lowered scene as a file, from which renders begin at once: its arrays are mapped into memory,
// and CPUs read the pages that rays touch. The arrays are those of one version of the kernels'
// contract (kernels/shared), so a tree is made again with each version: it is no archive.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>

#include "lower/flat_scene.h"

namespace caplet {

/// What the writer of a tree file says in it besides the scene; this room does not read it.
using TreeNotes = std::array<std::string, 3>;

/// Writes `scene` as write_atomically does (base/atomic_file.h). `progress` is called with what is
/// done, 0 to 1; what it throws ends the writing, and is thrown. Throws RunError when writing
/// fails.
void write_tree(const std::filesystem::path& file, const FlatScene& scene, const TreeNotes& notes,
                const std::function<void(double)>& progress = {});

struct TreeFile {
  FlatScene scene;
  TreeNotes notes;
  std::string fingerprint;  // of the scene, when it was written (fingerprint.h)
};

/// Maps a tree file. All but its large arrays is read and checked. Throws InputError for another
/// file, for one that is damaged or cut, or that another version wrote.
TreeFile map_tree(const std::filesystem::path& file);

/// Reads all of a tree. Throws InputError when it is not what was written.
void check_tree(const std::filesystem::path& file, const TreeFile& tree);

}  // namespace caplet
