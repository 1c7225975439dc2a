// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Converts RGB to spectra as in Jakob and Hanika 2019, "A Low-Dimensional Function Space for
// Efficient Spectral Upsampling".
#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <vector>

#include "scene/spectrum.h"

namespace caplet {

/// SigmoidFit is a sigmoid polynomial (spectrum_color.h: sigmoid_value) and how far its colour is
/// from the one requested.
struct SigmoidFit {
  std::array<double, 3> coefficients{0, 0, 0};  // of l^2, l, 1; l in nm
  double residual = 0;                          // largest difference in a channel of linear RGB
};

/// Returns the sigmoid whose colour under the space's illuminant is `rgb`, each channel clamped to
/// [0, 1]. The residual is below 1e-4 for sRGB, whose colours a sigmoid can all have; for colours
/// of wider spaces that no reflectance can have, it is the nearest that it finds. Grey is exactly
/// constant.
SigmoidFit fit_sigmoid(const glm::dvec3& rgb, ColorSpace space);

/// Returns the sigmoids of colours: CAPLET_UPLIFT_FLOATS floats, coefficients times the root of the
/// largest channel's value, over which channel is the largest, its value v (node i of n at v = 1 -
/// (1 - i / (n - 1))^2), then the third channel and the second in parts of it (nodes at the
/// squares). The channel after `top` is second. The table is made on first use.
const std::vector<float>& sigmoid_table(ColorSpace space);

/// Returns the colour of a sigmoid under the space's illuminant.
glm::dvec3 sigmoid_rgb(const std::array<double, 3>& coefficients, ColorSpace space);

}  // namespace caplet
