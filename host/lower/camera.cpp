// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "lower/camera.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <vector>

#include "base/check.h"
#include "lower/detail/floats.h"
#include "lower/motion.h"
#include "scene/frozen.h"

namespace caplet {

void lower_camera(const Scene& scene, FlatView& out) {
  const Camera& camera = scene.view.camera;
  const FilmSettings& film = scene.view.film;
  ViewRecord& view = out.view;
  view.width = narrow<uint>(film.width);
  view.height = narrow<uint>(film.height);
  const std::array<int, 4> window =
      film.crop.value_or(std::array<int, 4>{0, film.width, 0, film.height});
  view.crop_x = narrow<uint>(window[0]);
  view.crop_y = narrow<uint>(window[2]);
  view.crop_width = narrow<uint>(window[1] - window[0]);
  view.crop_height = narrow<uint>(window[3] - window[2]);

  view.clip_x = view.clip_y = view.clip_z = 0;
  view.clip_offset = std::numeric_limits<float>::infinity();
  if (const auto& clip = scene.view.clip) {
    view.clip_x = static_cast<float>(clip->normal.x);
    view.clip_y = static_cast<float>(clip->normal.y);
    view.clip_z = static_cast<float>(clip->normal.z);
    view.clip_offset = static_cast<float>(clip->offset);
  }

  CameraRecord& record = out.camera;
  record = CameraRecord{};
  out.camera_table.clear();
  const std::optional<MotionPath> motion =
      MotionPath::of(camera.motion, film, glm::dvec3(0), glm::dmat4(1), {scene.source});
  glm::dmat4 stands = camera.world_from_camera;
  if (!camera.motion.empty()) stands = AnimatedTransform(camera.motion).at(film.shutter_open);
  write_matrix(record.world_from_camera, stands);
  if (motion) {
    record.motion_segments = motion->segments();
    motion->append(false, out.camera_table);
  }
  const std::array<double, 4> plane = image_plane_of(camera, film);
  record.kind = narrow<uint>(camera.projection.index());  // cameras.def lists both
  record.mapping = std::visit([](const auto& of) { return of.mapping(); }, camera.projection);
  if (has_image_plane(camera)) {
    record.lens_radius = static_cast<float>(camera.lens_radius);
    record.focal_distance = static_cast<float>(camera.focal_distance);
    record.blades = camera.blades < 3 ? 0 : narrow<uint>(camera.blades);
    record.blade_rotation = static_cast<float>(glm::radians(camera.blade_rotation));
  }
  record.plane_x = static_cast<float>(plane[0]);
  record.plane_y = static_cast<float>(plane[3]);
  record.per_pixel_x = static_cast<float>((plane[1] - plane[0]) / film.width);
  record.per_pixel_y = static_cast<float>((plane[2] - plane[3]) / film.height);
  std::visit(
      [&](const auto& of) {
        if constexpr (requires { of.distortion(); })
          std::ranges::transform(of.distortion(), record.distortion,
                                 [](double value) { return static_cast<float>(value); });
        if constexpr (requires { of.table(0.0); }) {
          // Kernels load four floats at once.
          out.camera_table.resize((out.camera_table.size() + 3) / 4 * 4);
          record.lens_begin = narrow<uint>(out.camera_table.size());
          const std::vector<float> table = of.table(film.diagonal);
          out.camera_table.insert(out.camera_table.end(), table.begin(), table.end());
        }
      },
      camera.projection);
  // When the last row begins, as a share of all.
  const double late = film.readout > 0 ? film.readout / film.open_time() : 0;
  const bool is_across = film.readout_order >= 2, is_back = film.readout_order % 2 == 1;
  const float by_pixel =
      static_cast<float>((is_back ? -late : late) / (is_across ? film.width : film.height));
  record.exposure = static_cast<float>(1 - late);
  record.exposure_begin = is_back ? static_cast<float>(late) : 0;
  (is_across ? record.exposure_by_x : record.exposure_by_y) = by_pixel;
  record.medium = camera.medium.value_or(CAPLET_NONE);
  const bool is_parallel =
      std::visit([](const auto& of) { return of.is_parallel; }, camera.projection);
  // Other solids may hold the camera while it, or they, move.
  record.origins = is_parallel || record.lens_radius > 0 || moves(scene) || scene.view.clip ? 1 : 0;
}

RayRecord ray_of_pixel(const Scene& scene, int x, int y) {
  const Camera& camera = scene.view.camera;
  const glm::dmat4 world = camera.motion.empty()
                               ? camera.world_from_camera
                               : AnimatedTransform(camera.motion).at(scene.view.film.shutter_open);
  const CameraRay of = unproject(camera, scene.view.film, {x + 0.5, y + 0.5});
  const glm::dvec3 origin(world * glm::dvec4(of.origin, 1)),
      direction = glm::normalize(glm::dmat3(world) * of.direction);
  RayRecord ray{};
  ray.ox = static_cast<float>(origin.x) + 0.0f;  // no -0
  ray.oy = static_cast<float>(origin.y) + 0.0f;
  ray.oz = static_cast<float>(origin.z) + 0.0f;
  ray.dx = static_cast<float>(direction.x);
  ray.dy = static_cast<float>(direction.y);
  ray.dz = static_cast<float>(direction.z);
  ray.t_max = std::numeric_limits<float>::infinity();
  if (const auto& clip = scene.view.clip) {
    const double height = glm::dot(clip->normal, origin) - clip->offset,
                 rate = glm::dot(clip->normal, direction);
    if (height > 0 && rate < 0)
      ray.t_min = static_cast<float>(height / -rate);
    else if (height > 0)
      ray.t_max = 0;
    else if (rate > 0)
      ray.t_max = static_cast<float>(-height / rate);
  }
  return ray;
}

}  // namespace caplet
