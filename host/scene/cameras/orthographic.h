// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <algorithm>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>

#include "scene/camera_ray.h"

namespace caplet {

/// Rays are parallel; the screen window is in camera units.
struct OrthographicProjection {
  static constexpr bool has_window = true, has_plane = true, is_parallel = true;

  template <class Self, class Visit>
  static void fields(Self&, Visit&&) {}

  double plane_scale() const { return 1; }
  std::uint32_t mapping() const { return 0; }
  CameraRay ray(const glm::dvec2& place) const { return {glm::dvec3(place, 0), {0, 0, 1}}; }
  std::optional<glm::dvec2> place(const glm::dvec3& point) const { return glm::dvec2(point); }
  double footprint(const glm::dvec3&, const glm::dvec2& pixel) const {
    return std::min(pixel.x, pixel.y);
  }
};

}  // namespace caplet
