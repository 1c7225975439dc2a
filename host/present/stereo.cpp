// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "present/stereo.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace caplet {

Camera camera_of_eye(const Scene& scene, const Stereo& stereo, Eye eye) {
  Camera camera = scene.view.camera;
  const glm::dvec3 right(camera.world_from_camera[0]), forward(camera.world_from_camera[2]);
  const double side = eye == Eye::left ? -0.5 : 0.5;
  if (auto* const head = std::get_if<OmnistereoProjection>(&camera.projection)) {
    head->eye = side * stereo.separation / glm::length(right);
    return camera;
  }
  const auto set_aside = [&](glm::dmat4& matrix) {
    const glm::dvec3 aside = glm::normalize(glm::dvec3(matrix[0]));
    matrix[3] += glm::dvec4(side * stereo.separation * aside, 0);
  };
  set_aside(camera.world_from_camera);
  for (TransformKey& key : camera.motion) set_aside(key.matrix);
  if (!stereo.convergence || fov_of(camera) == 0) return camera;  // the image plane has no distance
  // By similar triangles, in the camera's own units, which transforms may stretch: the point in the
  // centre at that distance moves as far to one side as the eye has moved to the other.
  const double across = side * stereo.separation / glm::length(right),
               away = *stereo.convergence / glm::length(forward);
  const double shift = across / (away * std::tan(fov_of(camera) / 2));
  std::array<double, 4> window = screen_window_of(camera, scene.view.film);
  window[0] -= shift;
  window[1] -= shift;
  camera.screen_window = window;
  return camera;
}

}  // namespace caplet
