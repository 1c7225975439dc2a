// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "lower/camera.h"

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <limits>

#include "base/check.h"

namespace caplet {

void lower_camera(const Scene& scene, FlatView& out) {
  const Camera& camera = scene.camera;
  const FilmSettings& film = scene.film;
  ViewRecord& view = out.view;
  view.width = narrow<uint>(film.width);
  view.height = narrow<uint>(film.height);
  const std::array<int, 4> window = film.crop.value_or(std::array<int, 4>{0, film.width, 0, film.height});
  view.crop_x = narrow<uint>(window[0]);
  view.crop_y = narrow<uint>(window[2]);
  view.crop_width = narrow<uint>(window[1] - window[0]);
  view.crop_height = narrow<uint>(window[3] - window[2]);

  const std::array<double, 4> screen = screen_window_of(camera, film);
  const bool is_parallel = camera.fov == 0;
  const double unit = is_parallel ? 1 : std::tan(camera.fov / 2);  // half the shorter side, at distance 1

  CameraRecord& record = out.camera;
  record = CameraRecord{};
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 4; ++c) record.world_from_camera[r * 4 + c] = static_cast<float>(camera.world_from_camera[c][r]);
  record.screen_min_x = static_cast<float>(unit * screen[0]);
  record.screen_min_y = static_cast<float>(unit * screen[3]);
  record.screen_per_pixel_x = static_cast<float>(unit * (screen[1] - screen[0]) / film.width);
  record.screen_per_pixel_y = static_cast<float>(unit * (screen[2] - screen[3]) / film.height);
  record.lens_radius = static_cast<float>(camera.lens_radius);
  record.focal_distance = static_cast<float>(camera.focal_distance);
  record.medium = camera.medium.value_or(CAPLET_NONE);
  record.origins = is_parallel ? CAPLET_ORTHOGRAPHIC : camera.lens_radius > 0 ? 1 : 0;
}

RayRecord ray_of_pixel(const Scene& scene, int x, int y) {
  FlatView view;
  lower_camera(scene, view);
  const CameraRecord& camera = view.camera;
  const float* m = camera.world_from_camera;
  // In double from the numbers the device has.
  glm::dvec3 local(camera.screen_min_x + (x + 0.5) * camera.screen_per_pixel_x,
                   camera.screen_min_y + (y + 0.5) * camera.screen_per_pixel_y, 1);
  glm::dvec3 origin(m[3], m[7], m[11]);
  if (camera.origins == CAPLET_ORTHOGRAPHIC) {
    for (int r = 0; r < 3; ++r) origin[r] += m[4 * r] * local.x + m[4 * r + 1] * local.y;
    local = {0, 0, 1};
  }
  glm::dvec3 direction;
  for (int r = 0; r < 3; ++r) direction[r] = m[4 * r] * local.x + m[4 * r + 1] * local.y + m[4 * r + 2] * local.z;
  direction = glm::normalize(direction);
  RayRecord ray{};
  ray.ox = static_cast<float>(origin.x) + 0.0f;  // no -0
  ray.oy = static_cast<float>(origin.y) + 0.0f;
  ray.oz = static_cast<float>(origin.z) + 0.0f;
  ray.dx = static_cast<float>(direction.x);
  ray.dy = static_cast<float>(direction.y);
  ray.dz = static_cast<float>(direction.z);
  ray.t_max = std::numeric_limits<float>::infinity();
  return ray;
}

}  // namespace caplet
