// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Pictures as the page gets them: what changed since the one that it has, packed.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace caplet::view {

/// A picture that is shown. Row-major from the top left.
struct Picture {
  std::uint64_t version = 0;  // grows with each
  std::uint32_t view = 0;     // of the camera and the scene that it shows: pictures of one view converge to one
  int eye = 0;                // of a pair: 1 the right
  int width = 0, height = 0;  // of what was rendered
  int scale = 1;              // pixels of the page's picture along a side that one of these stands for
  std::uint32_t samples = 0;
  float noise = 0;                     // root mean square of the standard error of a pixel's luminance, over the mean luminance
  std::vector<std::uint16_t> color;    // R G B of each pixel, linear, half floats
  std::vector<std::uint32_t> objects;  // object.id and
  std::vector<std::uint32_t> primitives;  // primitive.id of each pixel
};

/// Pixels along a side of what is sent or not sent as one.
inline constexpr int tile_size = 64;

/// What `now` has that `before` has not, as a message (docs/viewer.md): whole where there is no picture before, or one of another
/// size. Ids go with the first picture of a view at full scale.
std::string packed(const Picture& now, const Picture* before);

/// Converts finite numbers and others; a value beyond the range of a half float becomes the
/// greatest, and 11 bits of 16 are kept: steps of 1/128.
std::uint16_t to_half(float value);

}  // namespace caplet::view
