// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Pixels as readers of image files give them.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

namespace caplet::image_files {

/// Pixels as the file holds them, made linear, before alpha is applied; row-major from the top, `channels` floats each.
struct Pixels {
  int width = 0, height = 0, channels = 0;
  int alpha = -1;  // channel, or none; not yet multiplied in
  std::vector<float> values;
};

/// Values as the file holds them, whole numbers from 0 to 1: bytes of a file of bytes, floats otherwise; of `is_whole` numbers.
/// Alpha is not multiplied in.
struct StoredPixels {
  int width = 0, height = 0, channels = 0;
  int alpha = -1;
  bool is_whole = false;
  std::vector<std::uint8_t> bytes;
  std::vector<float> floats;
};

/// Throws where an image of that width and height, with so many bytes a pixel, is refused.
using SizeCheck = std::function<void(int width, int height, std::uint64_t bytes_per_pixel)>;

}  // namespace caplet::image_files
