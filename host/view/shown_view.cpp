// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "view/detail/shown_view.h"

#include <algorithm>
#include <array>

#include "present/stereo.h"

namespace caplet::view {

namespace {

constexpr double usual_fov =
    0.7;  // used if an orthographic or spherical camera becomes a perspective one

}  // namespace

ShowView look_of(const View& own) {
  const Camera& camera = own.camera;
  ShowView out;
  out.width = own.film.width;
  out.height = own.film.height;
  out.world_from_camera = camera.world_from_camera;
  out.fov = fov_of(camera) > 0 ? fov_of(camera) : usual_fov;
  out.lens_radius = camera.lens_radius;
  out.focal_distance = camera.focal_distance;
  out.clip = own.clip;
  if (!is_orthographic(camera)) return out;
  const std::array<double, 4> window = screen_window_of(camera, own.film);
  out.orthographic = 0.5 * std::min(window[1] - window[0], window[3] - window[2]);
  return out;
}

View shown_view(const View& own, const ShowView& look, int scale, int eye) {
  View view = own;
  if (view.camera.world_from_camera != look.world_from_camera) view.camera.motion.clear();
  view.camera.world_from_camera = look.world_from_camera;
  view.camera.projection = PerspectiveProjection{look.fov};
  view.camera.lens_radius = look.lens_radius;
  view.camera.focal_distance = look.focal_distance;
  view.clip = look.clip;
  if (look.orthographic > 0) {
    const double pixel = look.orthographic / std::min(look.width, look.height);
    const double x = pixel * look.width, y = pixel * look.height;
    view.camera.projection = OrthographicProjection{};
    view.camera.screen_window = {-x, x, -y, y};
  } else if (is_orthographic(own.camera)) {
    view.camera.screen_window.reset();  // it is in units of the scene
  }
  view.film.crop.reset();
  view.film.width = (look.width - 1) / scale + 1;
  view.film.height = (look.height - 1) / scale + 1;
  if (!(look.separation > 0)) return view;
  Scene scene;
  scene.view.camera = view.camera;
  scene.view.film = view.film;
  const Stereo stereo{look.separation,
                      look.convergence > 0 ? std::optional(look.convergence) : std::nullopt};
  view.camera = camera_of_eye(scene, stereo, eye == 0 ? Eye::left : Eye::right);
  return view;
}

}  // namespace caplet::view
