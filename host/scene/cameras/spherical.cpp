// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "scene/cameras/spherical.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace caplet {

namespace {

constexpr double pi = std::numbers::pi;

/// Folds coordinates that lie beyond the square's edges, at most one square away, back into the
/// square.
glm::dvec2 folded(glm::dvec2 uv) {
  for (const int k : {0, 1}) {
    if (uv[k] >= 0 && uv[k] <= 1) continue;
    uv[k] = uv[k] < 0 ? -uv[k] : 2 - uv[k];
    uv[1 - k] = 1 - uv[1 - k];
  }
  return uv;
}

}  // namespace

CameraRay SphericalProjection::ray(const glm::dvec2& place) const {
  glm::dvec3 d;
  if (mapping_kind == equal_area) {
    d = sphere_from_square(folded(place));
  } else {
    const double theta = pi * place.y, phi = 2 * pi * place.x;
    d = {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
  }
  return {glm::dvec3(0), {d.x, d.z, d.y}};  // z is up in the maps, y in cameras
}

std::optional<glm::dvec2> SphericalProjection::place(const glm::dvec3& point) const {
  const double away = glm::length(point);
  if (!(away > 0)) return std::nullopt;
  const glm::dvec3 d = glm::dvec3(point.x, point.z, point.y) / away;
  if (mapping_kind == equal_area) return square_from_sphere(d);
  const double u = std::atan2(d.y, d.x) / (2 * pi);
  return glm::dvec2(u < 0 ? u + 1 : u, std::atan2(std::hypot(d.x, d.y), d.z) / pi);
}

double SphericalProjection::footprint(const glm::dvec3& point, const glm::dvec2& pixel) const {
  const double away = glm::length(point);
  if (mapping_kind == equal_area) return away * std::sqrt(4 * pi * pixel.x * pixel.y);
  return std::min(away * pi * pixel.y, 2 * pi * std::hypot(point.x, point.z) * pixel.x);
}

glm::dvec2 square_from_sphere(const glm::dvec3& d) {
  // This is 1 - |z|, computed from the other two coordinates to avoid cancellation near the poles.
  const double r = std::sqrt((d.x * d.x + d.y * d.y) / (1 + std::abs(d.z)));
  const double b = r * std::atan2(std::abs(d.y), std::abs(d.x)) * 2 / pi, a = r - b;
  return {0.5 * (std::copysign(d.z < 0 ? 1 - b : a, d.x) + 1),
          0.5 * (std::copysign(d.z < 0 ? 1 - a : b, d.y) + 1)};
}

glm::dvec3 sphere_from_square(const glm::dvec2& uv) {
  const double a = std::abs(2 * uv.x - 1), b = std::abs(2 * uv.y - 1);
  const double fold = 1 - (a + b), r = 1 - std::abs(fold);
  const double phi = pi / 4 * (r > 0 ? (b - a) / r + 1 : 1), across = r * std::sqrt(2 - r * r);
  return {std::copysign(across * std::cos(phi), 2 * uv.x - 1),
          std::copysign(across * std::sin(phi), 2 * uv.y - 1), std::copysign(1 - r * r, fold)};
}

}  // namespace caplet
