// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <glm/vec3.hpp>
#include <memory>

#include "scene/light_image.h"

namespace caplet {

/// How much brighter previews and the viewer show the shapes' light. The picture itself and its
/// backdrop stay.
struct PreviewExposure {
  double stops = 0;
  bool is_automatic = false;  // then the picture tells the stops (film/preview.h)
  bool operator==(const PreviewExposure&) const = default;
};

/// The most stops, up or down.
inline constexpr double most_stops = 32;

/// The background of the picture. Camera rays see it in place of the lights at infinity; all other
/// rays see the lights. It is composited under the render by coverage, and a preview shows it at
/// the brightness that is given here.
struct Backdrop {
  enum class Kind { transparent, color, image } kind = Kind::transparent;
  glm::dvec3 color{0};                            // as displayed, linear sRGB: 1 is white
  std::shared_ptr<const EnvironmentImage> image;  // as displayed, linear; it covers the whole
                                                  // picture, and the longer side is cropped evenly
};

}  // namespace caplet
