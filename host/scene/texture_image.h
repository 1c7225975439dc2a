// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "scene/spectrum.h"

namespace caplet {

/// How integer samples of an image encode values from 0 to 1. Floats are linear.
struct ImageEncoding {
  enum class Kind { srgb, linear, gamma } kind = Kind::srgb;
  double gamma = 1;  // the exponent that makes values linear

  bool operator==(const ImageEncoding&) const = default;
  auto operator<=>(const ImageEncoding&) const = default;
};

/// An image that textures look up: rows from the top, `channels` values per texel, stored as bytes
/// or as linear floats.
struct TextureImage {
  int width = 0, height = 0;
  int channels = 1;  // 1: grey; 3: red, green, blue; 4: with alpha, which is not premultiplied
  std::vector<std::uint8_t> bytes;
  std::array<float, 256> decoded{};  // the values of bytes, ascending; alpha is byte / 255
  std::vector<float> floats;
  ColorSpace space = ColorSpace::srgb;
  std::string file = {};  // the file that it was read from, with this encoding
  ImageEncoding encoding = {};

  std::size_t values() const {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(height) *
           static_cast<std::size_t>(channels);
  }
};

/// Returns the linear value of `value`, which is from 0 to 1.
double decoded_value(const ImageEncoding& encoding, double value);

}  // namespace caplet
