// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Converts the image of an infinite light to texels and the distribution that light sampling draws
// from.
#pragma once

#include <glm/vec3.hpp>

#include "lower/flat_scene.h"
#include "scene/scene.h"

namespace caplet {

/// Returns the direction (unit, the light's space) at `u`, `v` in [0, 1] of the image, v = 0 at the
/// top row. Latitude-longitude: z up, phi = 2 pi u, theta = pi v; equal area: Clarberg 2008, as
/// pbrt-v4.
glm::dvec3 environment_direction(bool equal_area, double u, double v);

/// These are integrals over the sphere of the image's luminance (1 for rgb (1 1 1), bilinear
/// between texels).
struct EnvironmentIntegrals {
  double luminance = 0;    // times steradian
  double illuminance = 0;  // of a surface facing +z, in the light's space
};

/// Returns a valid radiance: negative values and NaN become 0, infinity the largest float.
float usable(float x);
/// Returns the luminance of linear RGB of `space`; 1 for (1 1 1).
double luminance_of(const float* rgb, ColorSpace space);

/// Appends the texels of an image's colours to light_texels.
void append_texels(const EnvironmentImage& image, FlatScene& out);

/// Returns the radiance (linear RGB) of an image of a sky from a direction of its space: bilinear
/// between texels.
glm::dvec3 sky_rgb(const EnvironmentImage& image, const glm::dvec3& direction);

/// Appends an image to light_texels, and its distribution to light_cdf: its rows' running sum
/// (height + 1), then each row's (width + 1). The distribution is constant over a texel's cell and
/// proportional to the integral of the radiance's luminance over it, so it is positive wherever the
/// radiance is. Negative and NaN values count as 0, infinite ones as the largest float. An image
/// without light has a distribution of zeros.
EnvironmentIntegrals lower_environment(const EnvironmentImage& image, FlatScene& out);

}  // namespace caplet
