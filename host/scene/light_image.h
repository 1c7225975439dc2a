// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "scene/spectrum.h"

namespace caplet {

/// An image of a light. Pixels are linear RGB in `space`, row-major from the top, 3 floats each.
struct EnvironmentImage {
  int width = 0, height = 0;
  std::vector<float> rgb;
  ColorSpace space = ColorSpace::srgb;
  // As directions: square equal-area octahedral (pbrt-v4); otherwise latitude-longitude, 2:1, z up
  bool equal_area = false;
  std::string file = {};    // that it was read from
  std::string preset = {};  // or what scene files call it: an image of Caplet's own
};

/// What a light's data have of an image: its colours, or the means of their channels.
struct LightPicture {
  std::shared_ptr<const EnvironmentImage> image;
  bool is_grey = false;
};

}  // namespace caplet
