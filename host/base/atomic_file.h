// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Files are written beside their target and renamed into place, so that a killed run never leaves a broken file.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

namespace caplet {

/// Calls `write` with the path of a fresh file in the target's folder (same extension), then renames it over `target`. When
/// `write` throws, the temporary file is removed and `target` is as before. Throws RunError when the folder cannot be written or
/// the rename fails.
void write_atomically(const std::filesystem::path& target, const std::function<void(const std::filesystem::path&)>& write);

/// Throws InputError naming `flag` when a file at `target` could not be created (missing folder, no permission, is a folder).
void check_writable(const std::filesystem::path& target, const std::string& flag);

}  // namespace caplet
