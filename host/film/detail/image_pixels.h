// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This file holds pixels as readers of image files return them.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

namespace caplet::image_files {

/// Pixels are as the file holds them, made linear, before alpha is applied; row-major from the top,
/// `channels` floats each.
struct Pixels {
  int width = 0, height = 0, channels = 0;
  int alpha = -1;  // channel, or none; not yet multiplied in
  std::vector<float> values;
};

/// StoredPixels holds values as the file holds them, integers scaled to 0 to 1: bytes for a file of
/// bytes, floats otherwise; is_whole: the file has integers. Alpha is not multiplied in.
struct StoredPixels {
  int width = 0, height = 0, channels = 0;
  int alpha = -1;
  bool is_whole = false;
  std::vector<std::uint8_t> bytes;
  std::vector<float> floats;
};

/// This throws where an image of that width and height, with so many bytes a pixel, is refused.
using SizeCheck = std::function<void(int width, int height, std::uint64_t bytes_per_pixel)>;

}  // namespace caplet::image_files
