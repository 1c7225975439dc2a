// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <glm/vec3.hpp>

namespace caplet {

/// What a file may give of a light in place of its spectrum's magnitude.
enum class LightUnit { power, illuminance };

/// From where and where to a light at one point shines: all light goes off within `reach` (radians) of a direction that is within
/// `cone` of the axis. What is known of it where one of many lights is chosen.
struct LightReach {
  glm::dvec3 position{0};    // world
  glm::dvec3 axis{0, 0, 1};  // unit
  double cone = 0, reach = 0;
  double solid_angle = 0;  // that its power goes to
};

}  // namespace caplet
