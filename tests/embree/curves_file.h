// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Embree's test scenes of round curves: the .xml holds them, the .ecs beside it the camera. For
// tests alone.
#pragma once

#include <filesystem>
#include <glm/vec3.hpp>
#include <vector>

#include "peer.h"

namespace caplet::test {

/// The camera of Embree's viewer. A square image; pixel (x, y), y down, looks through its upper
/// left corner. Right-handed: x runs along view x up.
struct EcsCamera {
  glm::dvec3 eye{0, 0, -3}, target{0}, up{0, 1, 0};
  double fov = 90;  // degrees, over the height
};

/// The one RoundLineSegments of a file. Throws std::runtime_error where there is not one of them,
/// or where its numbers are not whole vertices or indices of two vertices.
RoundCurves read_round_curves(const std::filesystem::path& xml);

/// Options that are not the camera's are passed over, and lines that begin with #. Throws
/// std::runtime_error.
EcsCamera read_ecs(const std::filesystem::path& ecs);

std::vector<RayRecord> camera_rays(const EcsCamera& camera, int size);

}  // namespace caplet::test
