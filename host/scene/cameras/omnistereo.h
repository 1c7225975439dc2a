// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <numbers>
#include <optional>

#include "scene/camera_ray.h"
#include "scene/field.h"

namespace caplet {

/// One eye of a head that looks around: the rays of a column leave the circle on which the eye
/// moves, along its tangent (Peleg, Ben-Ezra and Pritch, "Omnistereo: panoramic stereo imaging",
/// 2001). Columns are even in longitude and rows in latitude; the middle of the picture looks along
/// +z.
struct OmnistereoProjection {
  double eye = 0;

  static constexpr bool has_window = false, has_plane = false, is_parallel = true;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit.number(
        {"eye", "how far the eye is from the head's middle, to the right; --stereo sets it",
         -no_limit, no_limit, "camera units"},
        self.eye);
  }

  double plane_scale() const { return 1; }
  std::uint32_t mapping() const { return 0; }
  std::array<double, 8> distortion() const { return {eye}; }
  CameraRay ray(const glm::dvec2& place) const {
    constexpr double pi = std::numbers::pi;
    const double azimuth = 2 * pi * (place.x - 0.5), polar = pi * place.y;
    return {eye * glm::dvec3(std::cos(azimuth), 0, -std::sin(azimuth)),
            glm::dvec3(std::sin(polar) * std::sin(azimuth), std::cos(polar),
                       std::sin(polar) * std::cos(azimuth))};
  }
  /// Nothing is seen inside the circle of the eye.
  std::optional<glm::dvec2> place(const glm::dvec3& point) const {
    constexpr double pi = std::numbers::pi;
    const double away = std::hypot(point.x, point.z);
    if (!(away > std::abs(eye))) return std::nullopt;
    const double along = std::sqrt((away - eye) * (away + eye));
    const double turns = (std::atan2(point.x, point.z) - std::atan2(eye, along)) / (2 * pi) + 0.5;
    return glm::dvec2(turns - std::floor(turns), std::atan2(along, point.y) / pi);
  }
  double footprint(const glm::dvec3& point, const glm::dvec2& pixel) const {
    constexpr double pi = std::numbers::pi;
    return std::min(glm::length(point) * pi * pixel.y,
                    2 * pi * std::hypot(point.x, point.z) * pixel.x);
  }
};

}  // namespace caplet
