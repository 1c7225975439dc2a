// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>

#include "scene/camera_ray.h"

namespace caplet {

/// Rays leave one point through the image plane z = 1.
struct PerspectiveProjection {
  double fov = 1.5707963267948966;  // radians, of the shorter image side, full angle

  static constexpr bool has_window = true, has_plane = true, is_parallel = false;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit.field_of_view(self.fov);
  }

  double plane_scale() const { return std::tan(fov / 2); }
  std::uint32_t mapping() const { return 0; }
  CameraRay ray(const glm::dvec2& place) const {
    return {glm::dvec3(0), glm::normalize(glm::dvec3(place, 1))};
  }
  std::optional<glm::dvec2> place(const glm::dvec3& point) const {
    if (!(point.z > 0)) return std::nullopt;
    return glm::dvec2(point) / point.z;
  }
  double footprint(const glm::dvec3& point, const glm::dvec2& pixel) const {
    return std::max(0.0, point.z) * std::min(pixel.x, pixel.y);
  }
};

}  // namespace caplet
