// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Restricts the files that a scene may name, to those beneath its own folder, or not at all.
// Importers ask here before they open or look for a file; tools/doors.py checks that they do.
#pragma once

#include <filesystem>
#include <optional>

#include "base/error.h"

namespace caplet {

/// While an instance exists, this thread may read only files beneath the folder of `scene`, after
/// links are resolved. For services that render untrusted files: these may change before they are
/// read, but not during reading.
class ReadingBeneath {
 public:
  explicit ReadingBeneath(const std::filesystem::path& scene);
  ~ReadingBeneath();
  ReadingBeneath(const ReadingBeneath&) = delete;
  ReadingBeneath& operator=(const ReadingBeneath&) = delete;

 private:
  std::optional<std::filesystem::path> before_;
};

/// While an instance exists, this thread may read any file: the user named it, not the scene.
class ReadingAnywhere {
 public:
  ReadingAnywhere();
  ~ReadingAnywhere();
  ReadingAnywhere(const ReadingAnywhere&) = delete;
  ReadingAnywhere& operator=(const ReadingAnywhere&) = delete;

 private:
  std::optional<std::filesystem::path> before_;
};

/// Throws InputError at `where` (or of the file itself, where that is empty) for a file that may
/// not be read, whether or not it exists.
void check_may_read(const std::filesystem::path& path, const SourceLocation& where = {});

/// Returns whether check_may_read accepts the path.
bool may_read(const std::filesystem::path& path);

/// Must be called before a file is opened: check_may_read and note_input (atomic_file.h).
void begin_reading(const std::filesystem::path& path, const SourceLocation& where = {});

/// Call check_may_read, then return whether the path exists, or is a regular file.
bool is_there(const std::filesystem::path& path, const SourceLocation& where);
bool is_file(const std::filesystem::path& path, const SourceLocation& where);

/// Resolves links, "." and ".." in `path`, even if it or a link's target does not exist; empty for
/// a loop of links.
std::filesystem::path without_links(const std::filesystem::path& path);

}  // namespace caplet
