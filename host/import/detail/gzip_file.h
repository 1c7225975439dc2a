// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Reads whole files, plain or gzipped.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>

#include "base/error.h"

namespace caplet {

/// Returns the bytes of a file, decompressed when it is gzipped. `where` is the place that names
/// the file (for messages; may be empty). Throws InputError when the file is missing, no regular
/// file, unreadable, broken, longer than `limit` bytes, or gzipped and unpacks to more than 64 MiB
/// and 100 times its size.
std::string read_file(const std::filesystem::path& path, const SourceLocation& where,
                      std::size_t limit = std::size_t{1} << 32);

/// Returns the most bytes that a packed file of `size` bytes may unpack to. Deflate packs 1032 to 1
/// at best, text and meshes less than a tenth of that: a file that unpacks to more is a
/// decompression bomb.
std::uintmax_t most_unpacked(std::uintmax_t size);

/// Reads text as read_file does. Bytes that cannot be in a text file are an error with their place.
std::string read_text(const std::filesystem::path& path, const SourceLocation& where);

/// Throws InputError at the first control character of `text` that is not a blank: the file is not
/// text.
void check_text(const std::string& text, const std::string& file);

}  // namespace caplet
