// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Coated materials of the trials, and Fresnel's reflectance in double.
#pragma once

#include <cmath>
#include <string>

#include "bsdf_device.h"

namespace caplet::test {

inline BsdfParameters coat(const std::string& name, uint kind, float coat_alpha) {
  BsdfParameters out;
  out.name = name;
  out.kind = kind;
  out.coat_alpha_u = out.coat_alpha_v = coat_alpha;
  return out;
}

/// From a medium of index 1 into one of index eta.
inline double fresnel(double cos_i, double eta) {
  const double sin2_t = (1 - cos_i * cos_i) / (eta * eta);
  if (sin2_t >= 1) return 1;
  const double cos_t = std::sqrt(1 - sin2_t);
  const double parallel = (eta * cos_i - cos_t) / (eta * cos_i + cos_t),
               across = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
  return 0.5 * (parallel * parallel + across * across);
}

/// What of diffuse light within an index of eta is reflected back by the boundary: 1 - (1 - r) /
/// eta^2, where r is the reflectance of diffuse light outside, by the midpoint rule.
inline double internal_reflectance(double eta) {
  const int steps = 100000;
  double outside = 0;
  for (int i = 0; i < steps; ++i) {
    const double cosine = (i + 0.5) / steps;
    outside += 2 * cosine * fresnel(cosine, eta) / steps;
  }
  return 1 - (1 - outside) / (eta * eta);
}

}  // namespace caplet::test
