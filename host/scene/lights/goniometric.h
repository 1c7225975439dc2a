// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <numbers>

#include "scene/field.h"
#include "scene/light_image.h"
#include "scene/lights/unit.h"
#include "scene/spectrum.h"

namespace caplet {

struct GoniometricLight {
  Spectrum intensity = ConstantSpectrum{1};  // multiplied by the image's value in each direction
  std::shared_ptr<const EnvironmentImage> image;  // the mean of the channels is used
  glm::dvec3 position{0};                         // world
  glm::dmat3 world_from_light{1};                 // rotation, possibly mirroring

  static constexpr LightUnit unit = LightUnit::power;
  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit.emission({"I", "radiant intensity, times the image's", 0}, self.intensity);
    visit.place(self.position, self.world_from_light);
    visit.directions({"filename", "image over all directions, square, equal-area"}, self.image);
  }
  double solid_angle(double, double) const { return 4 * std::numbers::pi; }
  LightReach reach() const { return {position, {0, 0, 1}, std::numbers::pi, 0, solid_angle(0, 0)}; }
  template <class Put>
  void data(Put&& put) const {
    // The image's axis is y (Pharr, Jakob and Humphreys 2023, section 12.2.3).
    const glm::dmat3 swapped(world_from_light[0], world_from_light[2], world_from_light[1]);
    put("position", position);
    put("light_from_world", swapped);
    put("picture", LightPicture{image, true});
  }
};

}  // namespace caplet
