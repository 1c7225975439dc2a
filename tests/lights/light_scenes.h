// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Scenes of lights alone, for the tests of lights.
#pragma once

#include <array>
#include <cstddef>
#include <glm/vec3.hpp>
#include <memory>
#include <vector>

#include "lower/lower.h"
#include "scene/scene.h"

namespace caplet::test {

/// These lights and a small grey ball far below them, for a scene has to hold something.
Scene scene_with(const std::vector<Light>& lights);

/// A light of the model, of scale 1.
template <class Model>
Light light_of(const Model& model) {
  Light light;
  light.model = model;
  return light;
}

/// The sky of an image: `rgb` has three values a texel.
std::shared_ptr<const EnvironmentImage> picture_image(int width, int height,
                                                      const std::vector<float>& rgb,
                                                      bool equal_area = false);
Light image_light(int width, int height, bool equal_area, const std::vector<float>& rgb);

/// Unit directions, evenly spread over the sphere.
std::vector<glm::dvec3> sphere_directions(std::size_t n);

}  // namespace caplet::test
