// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Reads and writes image files other than EXR: PNG by libpng (image_png.cpp), the rest by the
// module of OpenImageIO (image_module.h).
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "film/detail/image_pixels.h"

namespace caplet::image_files {

/// Throws InputError naming the file, and RunError where the module is missing.
Pixels read_linear(const std::filesystem::path& path);
/// Reads without multiplying by alpha. Throws as read_linear does.
StoredPixels read_stored(const std::filesystem::path& path);
/// Returns whether a file of that extension can be written.
bool can_write(const std::filesystem::path& path);
/// Returns whether a file of that extension, which can be written, can have that size.
bool can_hold(const std::filesystem::path& path, int width, int height);
bool can_write_alpha(const std::filesystem::path& path);
/// Returns the bytes of a file of 8-bit sRGB, 3 bytes a pixel or 4 with alpha (not multiplied in),
/// in the format of the path's extension. Throws RunError.
std::string encode_8bit(const std::filesystem::path& path, int width, int height, int channels,
                        const std::vector<std::uint8_t>& values);

}  // namespace caplet::image_files
