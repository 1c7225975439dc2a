// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <glm/vec3.hpp>

namespace caplet {

/// A ray in camera space, with a unit direction.
struct CameraRay {
  glm::dvec3 origin{0}, direction{0, 0, 1};
};

}  // namespace caplet
