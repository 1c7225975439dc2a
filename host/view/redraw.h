// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Draws the scene's files anew with other options, such as another style of a molecule.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace caplet::view {

/// Options of files by name; no option has an empty text.
using FileOptions = std::map<std::string, std::string>;

/// An option that the scene's files know, as the command line has it.
struct FileOption {
  std::string name, values, help;
  bool is_list = false;  // its text may have several lines
};

/// How the scene's files are read again. `read` throws InputError. No `read`: they are not.
struct SceneFiles {
  std::vector<FileOption> options;
  FileOptions now;
  std::function<Scene(FileOptions)> read;
};

/// Returns the options `now` with those of `changed`, where an empty text takes one away. Throws
/// InputError for an option that the files do not know, and for one that would name a file outside
/// the working folder.
FileOptions changed_options(const SceneFiles& files, const FileOptions& now,
                            const FileOptions& changed);

/// Returns what `read` makes of the files, with the view and the lights of `before`.
Scene redrawn(const SceneFiles& files, const FileOptions& options, const Scene& before);

}  // namespace caplet::view
