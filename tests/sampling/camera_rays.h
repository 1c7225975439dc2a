// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Rays of cameras on the test device.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>
#include <vector>

#include "scene/scene.h"
#include "shared/records.h"

namespace caplet::test::sampling_test {

struct WeighedRay {
  RayRecord ray;
  float weight;
};
/// The rays through points of the raster (x, y) and of the lens (z, w).
std::vector<WeighedRay> camera_rays(const Scene& scene, const std::vector<glm::vec4>& samples);

/// The ray through a point of the raster and of the lens.
RayRecord camera_ray(const Scene& scene, glm::vec2 raster, glm::vec2 lens);

/// How far apart rays of neighbouring pixels are, at the camera and added at length 1.
std::vector<float> camera_spread(const Scene& scene, glm::vec2 raster);

}  // namespace caplet::test::sampling_test
