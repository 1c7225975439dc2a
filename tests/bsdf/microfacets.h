// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Metals of GGX microfacets in double precision, by complex arithmetic.
#pragma once

#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>

#include "mitsuba_values.h"

namespace caplet::test {

/// Reflectance of unpolarised light at an interface to the complex index (Born and Wolf, 14.2).
inline double metal_reflectance(double cos_i, std::complex<double> index) {
  const std::complex<double> sin2 = 1 - cos_i * cos_i,
                             cos_t = std::sqrt(1.0 - sin2 / (index * index));
  return 0.5 * (std::norm((cos_i - index * cos_t) / (cos_i + index * cos_t)) +
                std::norm((index * cos_i - cos_t) / (index * cos_i + cos_t)));
}

/// GGX with height-correlated masking (Walter et al. 2007, 20 and 33; Heitz 2014, 99): f |cos wi|,
/// wo.z and wi.z > 0.
inline double microfacets(const Direction& wo, const Direction& wi, double alpha_u, double alpha_v,
                          std::complex<double> index) {
  double m[3], length = 0, cos_m = 0;
  for (std::size_t c = 0; c < 3; ++c) length += std::pow(m[c] = double{wo[c]} + double{wi[c]}, 2);
  for (std::size_t c = 0; c < 3; ++c) cos_m += (m[c] /= std::sqrt(length)) * double{wo[c]};
  const double slope = std::pow(m[0] / alpha_u, 2) + std::pow(m[1] / alpha_v, 2) + m[2] * m[2];
  const double d = 1 / (std::numbers::pi * alpha_u * alpha_v * slope * slope);
  const double g = 1 / (1 + ggx_lambda(wo, alpha_u, alpha_v) + ggx_lambda(wi, alpha_u, alpha_v));
  return metal_reflectance(cos_m, index) * d * g / (4 * double{wo[2]});
}

}  // namespace caplet::test
