// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <glm/vec3.hpp>

namespace caplet {

/// The photometric quantity that a file may give in place of the spectrum's magnitude.
enum class LightUnit { power, illuminance };

/// Bounds the directions of a light at one point: all light leaves within `reach` (radians) of a
/// direction that is within `cone` of the axis. The choice among many lights uses it.
struct LightReach {
  glm::dvec3 position{0};    // world
  glm::dvec3 axis{0, 0, 1};  // unit
  double cone = 0, reach = 0;
  double solid_angle = 0;  // the solid angle that its power goes to
};

}  // namespace caplet
