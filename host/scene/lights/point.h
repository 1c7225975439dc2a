// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <glm/vec3.hpp>
#include <numbers>

#include "scene/field.h"
#include "scene/lights/unit.h"
#include "scene/spectrum.h"

namespace caplet {

struct PointLight {
  Spectrum intensity = ConstantSpectrum{1};
  glm::dvec3 position{0};  // world

  static constexpr LightUnit unit = LightUnit::power;
  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit.emission({"I", "radiant intensity", 0}, self.intensity);
    visit.position({"from", "position"}, self.position);
  }
  double per_unit() const { return 4 * std::numbers::pi; }
  double power(double) const { return per_unit(); }
  LightReach reach() const { return {position, {0, 0, 1}, std::numbers::pi, 0, per_unit()}; }
  template <class Put>
  void data(Put&& put) const {
    put("position", position);
  }
};

}  // namespace caplet
