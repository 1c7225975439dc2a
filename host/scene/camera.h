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

#include "scene/all_cameras.h"
#include "scene/camera_ray.h"
#include "scene/field.h"
#include "scene/motion.h"

namespace caplet {

struct FilmSettings;

template <class, class... Types>
using ProjectionVariant = std::variant<Types...>;

#define CAMERA(name, Type) , Type
using Projection = ProjectionVariant<void
#include "shared/cameras.def"
                                     >;
#undef CAMERA

/// Lists the names of Projection's alternatives in scene files, in their order.
inline constexpr std::array projection_names = {
#define CAMERA(name, Type) #name,
#include "shared/cameras.def"
#undef CAMERA
};

inline constexpr Field fov_field = {
    "fov", "field of view of the picture's shorter side", 0, 180, "degrees", true};
inline constexpr Field half_fov_field = {"halffov", "half of it; above 0 it counts", -no_limit, 90,
                                         "degrees"};
inline constexpr Field frame_aspect_ratio_field = {
    "frameaspectratio",
    "width over height of what the camera sees; else that of the picture",
    0,
    no_limit,
    "",
    true};

struct Camera {
  glm::dmat4 world_from_camera{1};  // of one that moves: at its first key
  Projection projection;
  std::optional<double> frame_aspect_ratio;  // where there is a screen window
  std::optional<std::array<double, 4>>
      screen_window;            // where there is one: x min, x max, y min, y max
  double lens_radius = 0;       // where there is an image plane, camera units
  double focal_distance = 1e6;  // along z, camera units
  std::optional<std::uint32_t> medium =
      {};                     // the medium at a camera outside all solids: index into Scene::media
  TransformKeys motion = {};  // world_from_camera
  int blades = 0;             // corners of the lens; below 3 it is round
  double blade_rotation = 0;  // degrees, of the first corner from +x towards +y

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
    visit.integer({"blades", "corners of the lens; below 3 it is round", 0, 64}, self.blades);
    visit.number({"bladerotation", "of the first corner, from the right upwards", -no_limit,
                  no_limit, "degrees"},
                 self.blade_rotation);
  }
};

/// Returns whether the camera has an image plane, and so a lens and lengths in the picture.
inline bool has_image_plane(const Camera& camera) {
  return std::visit([](const auto& of) { return of.has_plane; }, camera.projection);
}
/// Returns whether the screen window says what the camera sees.
inline bool has_screen_window(const Camera& camera) {
  return std::visit([](const auto& of) { return of.has_window; }, camera.projection);
}
inline bool is_orthographic(const Camera& camera) {
  return std::holds_alternative<OrthographicProjection>(camera.projection);
}

/// Returns the field of view in radians; 0 where the projection has none.
double fov_of(const Camera& camera);

/// Returns the screen window: its shorter side is -1 to 1 unless a file says else.
std::array<double, 4> screen_window_of(const Camera& camera, const FilmSettings& film);

/// Returns what is shown as places (shared/cameras.def): {x min, x max, y min, y max}, in camera
/// units of the image plane where there is one; {0, 1, 1, 0} without a screen window.
std::array<double, 4> image_plane_of(const Camera& camera, const FilmSettings& film);

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

}  // namespace caplet
