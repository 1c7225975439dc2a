// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>

#include "scene/camera_ray.h"
#include "scene/field.h"

namespace caplet {

/// Rays leave one point in all directions, which the whole image covers.
struct SphericalProjection {
  enum Mapping { equal_area, equirectangular };
  int mapping_kind = equal_area;

  static constexpr bool has_window = false, has_plane = false, is_parallel = false;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    static constexpr std::array names = {"equalarea", "equirectangular"};
    visit.choice({"mapping", "how directions lie in the picture"}, self.mapping_kind, names);
  }

  double plane_scale() const { return 1; }
  std::uint32_t mapping() const { return static_cast<std::uint32_t>(mapping_kind); }
  CameraRay ray(const glm::dvec2& place) const;
  std::optional<glm::dvec2> place(const glm::dvec3& point) const;
  double footprint(const glm::dvec3& point, const glm::dvec2& pixel) const;
};

/// Maps a unit direction to [0, 1]^2 by the equal-area octahedral map, and back (Clarberg, "Fast
/// equal-area mapping of the (hemi)sphere using SIMD", 2008). The centre of the square is +z.
glm::dvec2 square_from_sphere(const glm::dvec3& direction);
glm::dvec3 sphere_from_square(const glm::dvec2& uv);

}  // namespace caplet
