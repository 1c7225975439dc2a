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

/// Rays leave one point. Their angle to the axis is proportional to the distance from the picture's
/// middle (equidistant), or equal areas of the picture are equal solid angles (equisolid).
struct FisheyeProjection {
  enum Mapping { equidistant, equisolid };
  int mapping_kind = equidistant;
  double fov = 180;  // degrees, across the shorter side

  static constexpr bool has_window = true, has_plane = false, is_parallel = false;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    static constexpr std::array names = {"equidistant", "equisolid"};
    visit.choice({"mapping", "angle by distance from the middle"}, self.mapping_kind, names);
    visit.number({"fov", "field of view of the picture's shorter side", 0, 360, "degrees", true},
                 self.fov);
  }

  double plane_scale() const {
    const double half = fov * std::numbers::pi / 360;
    return mapping_kind == equidistant ? half : std::sin(half / 2);
  }
  std::uint32_t mapping() const { return static_cast<std::uint32_t>(mapping_kind); }
  /// What lies beyond the field of view is seen too, to straight behind.
  CameraRay ray(const glm::dvec2& place) const {
    const double r = glm::length(place), angle = angle_at(r);
    const glm::dvec2 aside = r > 0 ? place * (std::sin(angle) / r) : glm::dvec2(0);
    return {glm::dvec3(0), glm::dvec3(aside, std::cos(angle))};
  }
  std::optional<glm::dvec2> place(const glm::dvec3& point) const {
    const double across = std::hypot(point.x, point.y);
    if (!(across > 0)) return point.z > 0 ? std::optional(glm::dvec2(0)) : std::nullopt;
    const double angle = std::atan2(across, point.z);
    return glm::dvec2(point) *
           ((mapping_kind == equidistant ? angle : std::sin(angle / 2)) / across);
  }
  double footprint(const glm::dvec3& point, const glm::dvec2& pixel) const {
    const double angle = std::atan2(std::hypot(point.x, point.y), point.z);
    // The lengths of a unit step on the picture, away from its middle and around it.
    double outward = 1, around = angle > 0 ? std::sin(angle) / angle : 1;
    if (mapping_kind == equisolid) {
      outward = 2 / std::max(1e-9, std::cos(angle / 2));
      around = 2 * std::cos(angle / 2);
    }
    return glm::length(point) * std::min(outward, around) * std::min(pixel.x, pixel.y);
  }

 private:
  double angle_at(double r) const {
    return mapping_kind == equidistant ? std::min(r, std::numbers::pi)
                                       : 2 * std::asin(std::min(r, 1.0));
  }
};

}  // namespace caplet
