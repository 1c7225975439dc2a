// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Cameras: their place and projection. Camera space is left-handed, as in pbrt: +x right, +y up, +z
// forward. Raster space is measured in pixels of the full image; (0, 0) is its top left corner.
#pragma once

#include <array>
#include <cstdint>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <variant>

#include "scene/field.h"

namespace caplet {

struct FilmSettings;

struct PerspectiveProjection {
  double fov = 1.5707963267948966;  // radians, of the shorter image side, full angle
};
/// Rays are parallel; the screen window is in camera units.
struct OrthographicProjection {};
/// Rays leave one point in all directions, which the whole image covers.
struct SphericalProjection {
  enum class Mapping { equal_area, equirectangular } mapping = Mapping::equal_area;
  static constexpr Field mapping_field = {"mapping", "how directions lie in the picture"};
  static constexpr std::array mapping_names = {"equalarea", "equirectangular"};
};
using Projection = std::variant<PerspectiveProjection, OrthographicProjection, SphericalProjection>;

struct Camera {
  glm::dmat4 world_from_camera{1};
  Projection projection;
  std::optional<double> frame_aspect_ratio;  // perspective and orthographic
  std::optional<std::array<double, 4>>
      screen_window;            // perspective and orthographic: x min, x max, y min, y max
  double lens_radius = 0;       // perspective and orthographic, camera units
  double focal_distance = 1e6;  // along z, camera units
  std::optional<std::uint32_t> medium =
      {};  // the medium at a camera outside all solids: index into Scene::media

  static constexpr Field parallel_lens_field = {
      "parallellens", "rays of a lens stay parallel; else it makes a perspective"};
  /// Visits the numbers that all cameras have.
  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit.number({"lensradius", "radius of the lens", 0, no_limit, "camera units"},
                 self.lens_radius);
    visit.number(
        {"focaldistance", "distance of what is sharp, along z", 0, no_limit, "camera units", true},
        self.focal_distance);
  }
};

inline bool is_spherical(const Camera& camera) {
  return std::holds_alternative<SphericalProjection>(camera.projection);
}
inline bool is_orthographic(const Camera& camera) {
  return std::holds_alternative<OrthographicProjection>(camera.projection);
}

/// Returns the field of view in radians; 0 where the projection has none.
double fov_of(const Camera& camera);

/// Returns the part of the image plane that is shown: z = 1 (perspective, in units of tan(fov / 2))
/// or z = 0 (orthographic).
std::array<double, 4> screen_window_of(const Camera& camera, const FilmSettings& film);

/// Returns the same part in camera units: {x min, x max, y min, y max}.
std::array<double, 4> image_plane_of(const Camera& camera, const FilmSettings& film);

struct CameraRay {
  glm::dvec3 origin{0},
      direction{0, 0, 1};  // camera space; the direction is a unit vector of camera space
};

/// Returns the ray from the centre of the lens through `raster`.
CameraRay unproject(const Camera& camera, const FilmSettings& film, const glm::dvec2& raster);

/// Projects a point of camera space to raster space. There is no value for a point behind a
/// perspective camera or at its place. The result may lie outside the image. unproject(project(p))
/// is a ray through p.
std::optional<glm::dvec2> project(const Camera& camera, const FilmSettings& film,
                                  const glm::dvec3& point);

/// Returns the world length of a pixel's shorter side at a world point; 0 where the camera does not
/// see the point.
double pixel_footprint(const Camera& camera, const FilmSettings& film, const glm::dvec3& point);

/// Maps a unit direction to [0, 1]^2 by the equal-area octahedral map, and back (Clarberg, "Fast
/// equal-area mapping of the (hemi)sphere using SIMD", 2008). The centre of the square is +z.
glm::dvec2 square_from_sphere(const glm::dvec3& direction);
glm::dvec3 sphere_from_square(const glm::dvec2& uv);

}  // namespace caplet
