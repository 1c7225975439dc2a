// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "present/lights.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <numbers>

#include "scene/transform.h"

namespace caplet {

namespace {

/// A round soft light: `radiance` within `radius` of `direction`, falling to 0 over `edge`. Angles
/// are in radians; the direction is in the viewer's axes (right, up, toward the viewer).
struct SoftLight {
  glm::dvec3 direction;
  double radius, edge;
  glm::dvec3 radiance;
};

glm::dvec3 from_angles(double azimuth, double elevation) {
  return {std::sin(azimuth) * std::cos(elevation), std::sin(elevation),
          std::cos(azimuth) * std::cos(elevation)};
}

EnvironmentImage image_of(const char* preset, const glm::dvec3& background,
                          const std::vector<SoftLight>& lights) {
  EnvironmentImage image;
  image.preset = preset;
  image.width = 512;
  image.height = 256;
  image.rgb.resize(3 * static_cast<std::size_t>(image.width) *
                   static_cast<std::size_t>(image.height));
  std::size_t texel = 0;
  for (int row = 0; row < image.height; ++row)
    for (int column = 0; column < image.width; ++column) {
      const double theta = std::numbers::pi * (row + 0.5) / image.height,
                   phi = 2 * std::numbers::pi * (column + 0.5) / image.width;
      // Light space has z up, x toward the viewer, y to the viewer's right.
      const glm::dvec3 direction(std::sin(theta) * std::sin(phi), std::cos(theta),
                                 std::sin(theta) * std::cos(phi));
      glm::dvec3 radiance = background;
      for (const SoftLight& light : lights) {
        const double angle = std::acos(std::clamp(glm::dot(direction, light.direction), -1.0, 1.0));
        const double t = std::clamp((light.radius + light.edge - angle) / light.edge, 0.0, 1.0);
        radiance += light.radiance * (t * t * (3 - 2 * t));
      }
      for (int channel = 0; channel < 3; ++channel)
        image.rgb[texel++] = static_cast<float>(radiance[channel]);
    }
  return image;
}

/// A disk of angular radius a gives the irradiance pi L sin(a)^2 at its centre. The key gives
/// about 2.8, so a reflectance of 0.6 facing it shows 0.53, and with fill and background 0.6 to
/// 0.7. All lights lie outside the camera's view (up to 33 degrees off its axis in the corners of a
/// 16:9 image).
EnvironmentImage studio() {
  return image_of(studio_preset, {0.020, 0.024, 0.032},
                  {{from_angles(glm::radians(-48.0), glm::radians(42.0)),
                    glm::radians(24.0),
                    glm::radians(8.0),
                    {4.2, 4.0, 3.7}},
                   {from_angles(glm::radians(62.0), glm::radians(8.0)),
                    glm::radians(30.0),
                    glm::radians(14.0),
                    {0.72, 0.8, 0.92}},
                   {from_angles(glm::radians(150.0), glm::radians(58.0)),
                    glm::radians(18.0),
                    glm::radians(8.0),
                    {2.8, 2.9, 3.1}}});
}

/// It has a smaller key from further to the side, hardly any fill, and rim lights from behind on
/// both sides.
EnvironmentImage dramatic() {
  return image_of(dramatic_preset, {0.004, 0.005, 0.007},
                  {{from_angles(glm::radians(-74.0), glm::radians(36.0)),
                    glm::radians(9.0),
                    glm::radians(4.0),
                    {30, 27.5, 23.5}},
                   {from_angles(glm::radians(140.0), glm::radians(20.0)),
                    glm::radians(16.0),
                    glm::radians(8.0),
                    {4.2, 5.0, 6.4}},
                   {from_angles(glm::radians(40.0), glm::radians(-30.0)),
                    glm::radians(30.0),
                    glm::radians(20.0),
                    {0.10, 0.13, 0.18}}});
}

}  // namespace

std::vector<std::string> light_presets() { return {studio_preset, dramatic_preset}; }

std::shared_ptr<const EnvironmentImage> studio_image() {
  static const auto image = std::make_shared<const EnvironmentImage>(studio());
  return image;
}

std::shared_ptr<const EnvironmentImage> light_preset(const std::string& name) {
  static const auto hard = std::make_shared<const EnvironmentImage>(dramatic());
  return name == studio_preset ? studio_image() : name == dramatic_preset ? hard : nullptr;
}

bool is_preset(const Light& light) {
  const auto* infinite = std::get_if<InfiniteLight>(&light.model);
  return infinite && infinite->image && !infinite->image->preset.empty();
}

glm::dmat3 around(const Camera& camera) {
  glm::dmat3 axes(camera.world_from_camera);
  for (int k = 0; k < 3; ++k)
    if (const double length = glm::length(axes[k]); !is_unit(length)) axes[k] /= length;
  return {-axes[2], axes[0], axes[1]};
}

}  // namespace caplet
