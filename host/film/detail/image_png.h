// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Reads and writes PNG by libpng: most textures and previews need no OpenImageIO.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "film/detail/image_pixels.h"

namespace caplet::image_files {

/// libpng by itself writes no larger sides (PNG_USER_WIDTH_MAX).
inline constexpr int max_png_side = 1000000;

/// Returns true when the file begins as a PNG file does.
bool is_png(const std::filesystem::path& path);

/// These return the error, without the file's name, or an empty text, as the functions of Module
/// do.
std::string read_png_linear(const std::filesystem::path& path, const SizeCheck& check, Pixels& out);
std::string read_png_stored(const std::filesystem::path& path, const SizeCheck& check,
                            StoredPixels& out);
/// Encodes `values`: sRGB, `channels` (1, 3 or 4) bytes a pixel, row-major from the top; alpha is
/// not multiplied in. `out`: the file's bytes.
std::string encode_png(int width, int height, int channels, const std::vector<std::uint8_t>& values,
                       std::string& out);
/// Encodes numbers of 16 bits, one a pixel, row-major from the top. `out`: the file's bytes.
std::string encode_grey_png(int width, int height, const std::vector<std::uint16_t>& values,
                            std::string& out);

}  // namespace caplet::image_files
