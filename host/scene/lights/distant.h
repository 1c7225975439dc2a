// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <glm/vec3.hpp>
#include <numbers>

#include "scene/field.h"
#include "scene/lights/unit.h"
#include "scene/spectrum.h"

namespace caplet {

struct DistantLight {
  Spectrum irradiance = ConstantSpectrum{1};  // pbrt's L: radiance times the delta direction
  glm::dvec3 direction{0, 0, -1};             // unit, world, the way the light travels

  static constexpr LightUnit unit = LightUnit::illuminance;
  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit.emission({"L", "irradiance at right angles", 0}, self.irradiance);
    visit.direction({"from", "a point"}, {"to", "a point towards which light goes from there"},
                    self.direction);
  }
  double per_unit() const { return 1; }
  double power(double radius) const { return std::numbers::pi * radius * radius; }
  template <class Put>
  void data(Put&& put) const {
    put("direction", -direction);
  }
};

}  // namespace caplet
