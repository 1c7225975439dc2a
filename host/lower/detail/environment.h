// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The image of an infinite light -> texels and the distribution that light sampling draws from.
#pragma once

#include <glm/vec3.hpp>
#include <memory>

#include "lower/flat_scene.h"
#include "scene/scene.h"

namespace caplet {

/// Direction (unit, the light's space) at `u`, `v` in [0, 1] of the image, v = 0 at the top row. Latitude-longitude: z up,
/// phi = 2 pi u, theta = pi v; equal area: Clarberg 2008, as pbrt-v4.
glm::dvec3 environment_direction(bool equal_area, double u, double v);

/// Integrals over the sphere of the image's luminance (1 for rgb (1 1 1), bilinear between texels).
struct EnvironmentIntegrals {
  double luminance = 0;    // times steradian
  double illuminance = 0;  // of a surface facing +z, in the light's space
};

/// The image whose texels a FlatScene holds.
struct LoweredEnvironment {
  std::shared_ptr<const EnvironmentImage> image;
  EnvironmentIntegrals integrals;
};

/// Fills environment_texels, environment_cdf and lighting.environment_*. The distribution is constant over a texel's cell and
/// proportional to the integral of the radiance's luminance over it, so it is positive wherever the radiance is. Negative and NaN
/// values count as 0, infinite ones as the largest float. An image without light has a distribution of zeros.
EnvironmentIntegrals lower_environment(const EnvironmentImage& image, FlatScene& out);

}  // namespace caplet
