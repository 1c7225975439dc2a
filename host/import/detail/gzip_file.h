// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Files read whole, plain or gzipped.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "base/error.h"

namespace caplet {

/// The bytes of a file, decompressed when it is gzipped. `where` is what names the file (for messages; may be empty). Throws
/// InputError when the file is missing, no regular file, unreadable, broken, longer than `limit` bytes, or gzipped and unpacking
/// to more than 64 MiB and 100 times its size.
std::string read_file(const std::filesystem::path& path, const SourceLocation& where, std::size_t limit = std::size_t{1} << 32);

/// As read_file, for text: bytes that cannot be in a text file are an error with their place.
std::string read_text(const std::filesystem::path& path, const SourceLocation& where);

/// Throws InputError at the first control character of `text` that is not a blank: the file is not text.
void check_text(const std::string& text, const std::string& file);

}  // namespace caplet
