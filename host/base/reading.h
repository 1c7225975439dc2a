// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// A scene's files may name anything, or only what lies beneath the scene's own folder. Importers ask here before they open or
// look for a file; tools/doors.py sees to it.
#pragma once

#include <filesystem>
#include <optional>

#include "base/error.h"

namespace caplet {

/// While one lives, this thread may read what lies beneath the folder of `scene` alone, wherever links lead. What holds for a
/// service that renders files of strangers: they can be changed before they are read, but not while they are.
class ReadingBeneath {
 public:
  explicit ReadingBeneath(const std::filesystem::path& scene);
  ~ReadingBeneath();
  ReadingBeneath(const ReadingBeneath&) = delete;
  ReadingBeneath& operator=(const ReadingBeneath&) = delete;

 private:
  std::optional<std::filesystem::path> before_;
};

/// While one lives, this thread may read anything: what the user has named, not the scene.
class ReadingAnywhere {
 public:
  ReadingAnywhere();
  ~ReadingAnywhere();
  ReadingAnywhere(const ReadingAnywhere&) = delete;
  ReadingAnywhere& operator=(const ReadingAnywhere&) = delete;

 private:
  std::optional<std::filesystem::path> before_;
};

/// Throws InputError at `where` (or of the file itself, where that is empty) for a file that may not be read, whether it exists
/// or not.
void check_may_read(const std::filesystem::path& path, const SourceLocation& where = {});

/// Whether check_may_read lets it pass.
bool may_read(const std::filesystem::path& path);

/// To be called before a file is opened: check_may_read and note_input (atomic_file.h).
void begin_reading(const std::filesystem::path& path, const SourceLocation& where = {});

/// check_may_read, then whether something is there; of the second a regular file.
bool is_there(const std::filesystem::path& path, const SourceLocation& where);
bool is_file(const std::filesystem::path& path, const SourceLocation& where);

/// `path` without links, "." and "..", also where it, or what a link leads to, does not exist; empty where links go in a circle.
std::filesystem::path without_links(const std::filesystem::path& path);

}  // namespace caplet
