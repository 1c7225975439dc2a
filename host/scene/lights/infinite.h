// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <glm/mat3x3.hpp>
#include <memory>
#include <vector>

#include "scene/lights/unit.h"
#include "scene/spectrum.h"

namespace caplet {

/// An infinite light. Image pixels are linear RGB in `space`, row-major from the top, 3 floats each.
struct EnvironmentImage {
  int width = 0, height = 0;
  std::vector<float> rgb;
  ColorSpace space = ColorSpace::srgb;
  bool equal_area = false;  // square equal-area octahedral (pbrt-v4); otherwise latitude-longitude, 2:1, z up
};
struct InfiniteLight {
  Spectrum radiance = ConstantSpectrum{1};  // without an image
  std::shared_ptr<const EnvironmentImage> image;
  glm::dmat3 world_from_light{1};  // rotation, possibly mirroring

  static constexpr LightUnit unit = LightUnit::illuminance;
  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit.sky(self);
  }
};

}  // namespace caplet
