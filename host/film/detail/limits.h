// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// These functions limit what a file may claim before memory is allocated for it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace caplet {

inline constexpr int max_image_side = 1 << 20;
inline constexpr std::uint64_t max_tile_pixels = std::uint64_t{1} << 24;

/// Returns the bytes of a regular file that can be opened. Throws InputError naming it otherwise.
std::uintmax_t readable_file_bytes(const std::filesystem::path& path);

/// Throws InputError naming the file when the sides are not in 1..max_image_side, when there are
/// more than most_image_pixels (scene/film.h), or when the pixels would take more memory than
/// `file_bytes` can hold: beyond 64 MiB, 2048 times the file's size (zlib's best is 1032).
void check_image_size(const std::filesystem::path& path, std::int64_t width, std::int64_t height,
                      std::uint64_t bytes_per_pixel, std::uint64_t file_bytes);

/// Returns the text up to the first line break.
std::string first_line(const std::string& text);

}  // namespace caplet
