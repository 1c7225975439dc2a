// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Pictures for the page, encoded as compressed differences.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace caplet::view {

/// A picture that the page shows. It is row-major from the top left.
struct Picture {
  std::uint64_t version = 0;  // increases with every picture
  std::uint32_t view = 0;  // number of the camera and scene: pictures of one view converge to one
  int eye = 0;             // 1: the right of a stereo pair
  int width = 0, height = 0;  // of the rendered picture
  int scale = 1;              // one pixel covers so many pixels per side of the page's picture
  std::uint32_t samples = 0;
  bool is_denoised = false;  // the colours are without noise, and may be of fewer samples
  float noise =
      0;  // root mean square of the standard error of a pixel's luminance, over the mean luminance
  std::vector<std::uint16_t> color;  // R G B of each pixel, linear, half floats
  // Coverage of each pixel, half floats, where the page puts the backdrop under it; else empty.
  std::vector<std::uint16_t> alpha;
  std::vector<std::uint32_t> objects;     // object.id of each pixel
  std::vector<std::uint32_t> primitives;  // primitive.id of each pixel
};

/// The side in pixels of a tile, which is sent completely or not at all.
inline constexpr int tile_size = 64;

/// Encodes the difference between `now` and `before` as a message (docs/viewer.md): the whole
/// picture if there is no earlier one of the same size. Ids are sent with the first picture of a
/// view at full scale.
std::string packed(const Picture& now, const Picture* before);

/// Converts finite numbers and others; a value beyond the range of a half float becomes the
/// greatest, and 11 bits of 16 are kept: steps of 1/128.
std::uint16_t to_half(float value);

}  // namespace caplet::view
