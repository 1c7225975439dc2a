// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <numbers>

#include "scene/field.h"
#include "scene/light_image.h"
#include "scene/lights/unit.h"

namespace caplet {

struct ProjectionLight {
  std::shared_ptr<const EnvironmentImage> image;
  double fov = 90;                 // degrees, of the image's shorter side, full angle
  glm::dvec3 position{0};          // world
  glm::dmat3 world_from_light{1};  // rotation, possibly mirroring

  static constexpr LightUnit unit = LightUnit::power;
  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit.place(self.position, self.world_from_light);
    visit.image({"filename", "the picture that is projected"}, self.image);
    visit.number({"fov", "field of view of the picture's shorter side", 0.001, 179.999, "degrees"},
                 self.fov);
  }
  /// Returns the cubed cosine of the point at distance 1 (Pharr, Jakob and Humphreys 2023,
  /// section 12.2.2).
  double solid_angle(double u, double v) const {
    const double x = (2 * u - 1) * half_width(), y = (2 * v - 1) * half_height();
    return 4 * half_width() * half_height() / std::pow(1 + x * x + y * y, 1.5);
  }
  LightReach reach() const {
    const double x = half_width(), y = half_height(), to_corner = std::atan(std::hypot(x, y));
    const double solid_angle = 4 * std::asin(x * y / std::sqrt((1 + x * x) * (1 + y * y)));
    return {position, world_from_light[2], to_corner, 0, solid_angle};
  }
  template <class Put>
  void data(Put&& put) const {
    put("position", position);
    put("light_from_world",
        glm::dmat3(world_from_light[0], -world_from_light[1], world_from_light[2]));
    put("across", 0.5 / half_width());
    put("down", 0.5 / half_height());
    put("picture", LightPicture{image, false});
  }

  // These are half sizes of the image at distance 1 from the light.
  double half_width() const { return opposite() * std::max(1.0, aspect()); }
  double half_height() const { return opposite() * std::max(1.0, 1 / aspect()); }

 private:
  double opposite() const { return std::tan(fov * std::numbers::pi / 360); }
  double aspect() const { return static_cast<double>(image->width) / image->height; }
};

}  // namespace caplet
