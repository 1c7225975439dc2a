// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <glm/vec3.hpp>
#include <memory>

#include "scene/light_image.h"

namespace caplet {

/// What stands behind the shapes of a picture in place of the lights at infinity, which camera rays then do not see (all other
/// rays do). It is put under the picture after the render, by its coverage, and is as bright in a preview as it is said to be.
struct Backdrop {
  enum class Kind { transparent, color, image } kind = Kind::transparent;
  glm::dvec3 color{0};  // displayed, linear sRGB: 1 is white
  std::shared_ptr<const EnvironmentImage>
      image;  // displayed, linear; it covers the whole picture, cut off evenly where it is longer
};

}  // namespace caplet
