// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "present/depth_plane.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

namespace caplet {

std::array<double, 4> depth_plane_of(const Camera& camera) {
  const glm::dmat4& m = camera.world_from_camera;
  // Planes are moved by the inverse transpose, so that a scaled camera's plane stays across.
  const glm::dvec3 n =
      glm::normalize(glm::transpose(glm::inverse(glm::dmat3(m))) * glm::dvec3(0, 0, 1));
  return {n.x, n.y, n.z, -glm::dot(n, glm::dvec3(m[3]))};
}

}  // namespace caplet
