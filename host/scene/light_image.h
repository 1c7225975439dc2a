// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "scene/spectrum.h"

namespace caplet {

/// An image that a light uses. Pixels are linear RGB in `space`, row-major from the top, 3 floats
/// each.
struct EnvironmentImage {
  int width = 0, height = 0;
  std::vector<float> rgb;
  ColorSpace space = ColorSpace::srgb;
  // True: the map is square and equal-area octahedral (pbrt-v4). False: it is latitude-longitude,
  // 2:1, with z up.
  bool equal_area = false;
  std::string file = {};    // the file that it was read from
  std::string preset = {};  // or the name, in scene files, of an image that Caplet makes
};

/// What a light's device data take from an image: its colours, or the mean of the channels.
struct LightPicture {
  std::shared_ptr<const EnvironmentImage> image;
  bool is_grey = false;
};

}  // namespace caplet
