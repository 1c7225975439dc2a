// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The cache folder holds small files that are found by a key and checked when read. An unusable
// folder or a broken file is a miss, never an error; the first failure to store is warned of.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace caplet {

/// Returns $CAPLET_CACHE, else $XDG_CACHE_HOME/caplet, else $HOME/.cache/caplet; empty when none of
/// them is set.
std::filesystem::path cache_folder();

/// Returns what was stored under `key` (any text), or nothing when the file is missing, of another
/// version or key, cut short or altered.
std::optional<std::vector<unsigned char>> cache_load(std::string_view key,
                                                     std::string_view extension);
/// Returns false when it could not be stored.
bool cache_store(std::string_view key, std::string_view extension,
                 const std::vector<unsigned char>& contents);
/// Returns the file that holds `key`; empty without a folder.
std::filesystem::path cache_file(std::string_view key, std::string_view extension);

}  // namespace caplet
