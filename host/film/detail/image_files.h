// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Image files other than EXR. image_oiio.cpp does it with OpenImageIO; image_none.cpp stands in where that is not built.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace caplet::image_files {

/// Pixels as the file holds them, made linear, before alpha is applied; row-major from the top, `channels` floats each.
struct Pixels {
  int width = 0, height = 0, channels = 0;
  int alpha = -1;  // channel, or none; not yet multiplied in
  std::vector<float> values;
};

bool available();
/// Throws InputError naming the file, or naming the build option where this is not built.
Pixels read_linear(const std::filesystem::path& path);
/// Values as the file holds them, whole numbers from 0 to 1: bytes of a file of bytes, floats otherwise; of `is_whole` numbers.
/// Alpha is not multiplied in. Throws as read_linear does.
struct StoredPixels {
  int width = 0, height = 0, channels = 0;
  int alpha = -1;
  bool is_whole = false;
  std::vector<std::uint8_t> bytes;
  std::vector<float> floats;
};
StoredPixels read_stored(const std::filesystem::path& path);
/// Whether a file of that extension can be written.
bool can_write(const std::filesystem::path& path);
/// Whether a file of that extension, which can be written, can be of that size.
bool can_hold(const std::filesystem::path& path, int width, int height);
bool can_write_alpha(const std::filesystem::path& path);
/// The bytes of a file of 8-bit sRGB, 3 bytes a pixel or 4 with alpha (not multiplied in), in the format of the path's extension.
/// Throws RunError.
std::string encode_8bit(const std::filesystem::path& path, int width, int height, int channels,
                        const std::vector<std::uint8_t>& values);

}  // namespace caplet::image_files
