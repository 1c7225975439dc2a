// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/vec3.hpp>
#include <numbers>

#include "scene/field.h"
#include "scene/lights/unit.h"
#include "scene/spectrum.h"

namespace caplet {

struct SpotLight {
  Spectrum intensity = ConstantSpectrum{1};
  glm::dvec3 position{0};
  glm::dvec3 direction{0, 0, 1};            // unit, world, along the axis
  double total_angle = 0.5235987755982988;  // half angle of the cone
  double falloff_start_angle =
      0.4363323129985824;  // where the smooth falloff starts (smoothstep in cos, as pbrt-v4)

  static constexpr Field cone_field = {"coneangle", "half angle of the cone", 0, 180, "degrees"};
  static constexpr Field delta_field = {
      "conedeltaangle", "width of the smooth edge within the cone", 0, 180, "degrees"};

  static constexpr LightUnit unit = LightUnit::power;
  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit.emission({"I", "radiant intensity on the axis", 0}, self.intensity);
    visit.position({"from", "position"}, self.position);
    visit.direction({"from", "position"}, {"to", "a point on the axis"}, self.direction);
    visit.cone(self.total_angle, self.falloff_start_angle);
  }
  /// Returns the solid angle of the cone; the smooth edge counts half, which is its mean.
  double per_unit() const {
    const double total = cos_total(), start = cos_falloff_start();
    return 2 * std::numbers::pi * ((1 - start) + (start - total) / 2);
  }
  double power(double) const { return per_unit(); }
  LightReach reach() const {
    const double start = std::acos(cos_falloff_start());
    return {position, direction, start, total_angle - start, per_unit()};
  }
  template <class Put>
  void data(Put&& put) const {
    put("position", position);
    put("axis", direction);
    put("cos_total", cos_total());
    put("cos_falloff_start", cos_falloff_start());
  }

  double cos_total() const { return std::cos(total_angle); }
  double cos_falloff_start() const { return std::cos(std::min(falloff_start_angle, total_angle)); }
};

}  // namespace caplet
