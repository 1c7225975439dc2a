// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <array>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>

#include "scene/field.h"
#include "scene/light_image.h"
#include "scene/lights/unit.h"
#include "scene/spectrum.h"

namespace caplet {

/// The corners of a rectangle in the world, in order around it. It is seen along the direction (p3
/// - p0) x (p1 - p0), and light passes through it the opposite way.
using LightPortal = std::array<glm::dvec3, 4>;

/// A light at infinity.
struct InfiniteLight {
  Spectrum radiance = ConstantSpectrum{1};  // used without an image
  std::shared_ptr<const EnvironmentImage> image;
  glm::dmat3 world_from_light{1};       // rotation, possibly mirroring
  std::optional<LightPortal> portal{};  // the light is seen only through it

  static constexpr Field radiance_field = {"L", "radiance, the same in all directions", 0};
  static constexpr Field image_field = {
      "filename", "image over all directions: square equal-area, or 2:1 latitude-longitude"};
  static constexpr Field preset_field = {"preset", "a sky of Caplet's own by its name"};
  static constexpr Field portal_field = {"portal",
                                         "corners of a rectangle through which alone it is seen"};

  static constexpr LightUnit unit = LightUnit::illuminance;
  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit.sky(self);
  }
};

}  // namespace caplet
