// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "light_scenes.h"

#include <cmath>
#include <memory>
#include <numbers>

namespace caplet::test {

Scene scene_with(const std::vector<Light>& lights) {
  Scene scene;
  scene.materials.emplace_back();
  Shape small;
  small.geometry = SphereShape{0.01};
  small.world_from_object[3] = glm::dvec4(0, 0, -50, 1);
  scene.shapes = {small};
  scene.lights = lights;
  return scene;
}

std::shared_ptr<const EnvironmentImage> picture_image(int width, int height,
                                                      const std::vector<float>& rgb,
                                                      bool equal_area) {
  return std::make_shared<EnvironmentImage>(
      EnvironmentImage{width, height, rgb, ColorSpace::srgb, equal_area});
}

Light image_light(int width, int height, bool equal_area, const std::vector<float>& rgb) {
  InfiniteLight model;
  model.image = picture_image(width, height, rgb, equal_area);
  return light_of(model);
}

std::vector<glm::dvec3> sphere_directions(std::size_t n) {
  std::vector<glm::dvec3> directions;
  for (std::size_t i = 0; i < n; ++i) {
    const double z = 1 - (2 * static_cast<double>(i) + 1) / static_cast<double>(n),
                 r = std::sqrt(1 - z * z);
    const double phi = static_cast<double>(i) * std::numbers::pi * (3 - std::sqrt(5.0));
    directions.emplace_back(r * std::cos(phi), r * std::sin(phi), z);
  }
  return directions;
}

}  // namespace caplet::test
