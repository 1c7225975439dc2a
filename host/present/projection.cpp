// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "present/projection.h"

#include <fmt/format.h>

#include <cmath>
#include <glm/ext/matrix_transform.hpp>
#include <glm/matrix.hpp>

#include "base/error.h"
#include "present/present.h"

namespace caplet {

namespace {

/// Multiplies `matrix` from the right to the camera's transforms.
void turn_camera_space(Camera& camera, const glm::dmat4& matrix) {
  camera.world_from_camera = camera.world_from_camera * matrix;
  for (TransformKey& key : camera.motion) key.matrix = key.matrix * matrix;
}

}  // namespace

void change_projection(Camera& camera, bool to_orthographic, const glm::dvec3& middle,
                       const std::string& flag) {
  const double depth = (glm::inverse(camera.world_from_camera) * glm::dvec4(middle, 1)).z;
  const auto* const perspective = std::get_if<PerspectiveProjection>(&camera.projection);
  if (!perspective && !is_orthographic(camera))
    throw InputError({flag},
                     fmt::format("a camera \"{}\" has neither projection: with --view the scene is "
                                 "framed anew",
                                 projection_names[camera.projection.index()]));
  if (to_orthographic == is_orthographic(camera)) return;
  if (to_orthographic) {
    if (!(depth > 0))
      throw InputError({flag},
                       "the middle of the scene lies behind its camera: with --view it is "
                       "framed anew");
    // The screen window keeps its numbers, so that it follows the film's size: lengths are scaled.
    const double scale = depth * perspective->plane_scale();
    turn_camera_space(camera, glm::scale(glm::dmat4(1), glm::dvec3(scale)));
    camera.lens_radius /= scale;
    camera.focal_distance /= scale;
    camera.projection = OrthographicProjection{};
  } else {
    const PerspectiveProjection out{automatic_field_of_view};
    const double away = 1 / out.plane_scale() - depth;
    turn_camera_space(camera, glm::translate(glm::dmat4(1), glm::dvec3(0, 0, -away)));
    camera.focal_distance += away;
    camera.projection = out;
  }
}

}  // namespace caplet
