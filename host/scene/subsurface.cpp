// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "scene/media/subsurface.h"

#include <algorithm>
#include <cmath>

namespace caplet {

namespace {

double fresnel(double cosine, double eta) {
  const double sine2 = (1 - cosine * cosine) / (eta * eta);
  if (sine2 >= 1) return 1;
  const double beyond = std::sqrt(1 - sine2);
  const double parallel = (eta * cosine - beyond) / (eta * cosine + beyond),
               across = (cosine - eta * beyond) / (cosine + eta * beyond);
  return 0.5 * (parallel * parallel + across * across);
}

}  // namespace

double even_reflectance(double eta) {
  // Even steps of the squared cosine, by which even light comes.
  constexpr int steps = 4096;
  double sum = 0;
  for (int i = 0; i < steps; ++i) sum += fresnel(std::sqrt((i + 0.5) / steps), eta);
  return sum / steps;
}

double albedo_within(double reflectance, double eta, double g) {
  const double r = std::clamp(reflectance, 0.0, 1.0), within = even_reflectance(1 / eta);
  const double bare = r / (1 - within + within * r);
  // 0.139 s^2 - (1.139 + 1.17 bare) s + 1 - bare = 0
  const double b = 1.139 + 1.17 * bare, c = 1 - bare;
  const double s = 2 * c / (b + std::sqrt(std::max(0.0, b * b - 4 * 0.139 * c)));
  return std::clamp((1 - s * s) / (1 - g * s * s), 0.0, 1.0);
}

}  // namespace caplet
