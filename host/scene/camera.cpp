// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "scene/camera.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <numbers>

#include "scene/film.h"

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

glm::dvec3 spherical_direction(const SphericalProjection& of, const glm::dvec2& uv) {
  glm::dvec3 d;
  if (of.mapping == SphericalProjection::Mapping::equal_area) {
    d = sphere_from_square(folded(uv));
  } else {
    const double theta = pi * uv.y, phi = 2 * pi * uv.x;
    d = {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
  }
  return {d.x, d.z, d.y};  // z is up in the maps, y in cameras
}

glm::dvec2 spherical_place(const SphericalProjection& of, const glm::dvec3& direction) {
  const glm::dvec3 d(direction.x, direction.z, direction.y);
  if (of.mapping == SphericalProjection::Mapping::equal_area) return square_from_sphere(d);
  const double u = std::atan2(d.y, d.x) / (2 * pi);
  return {u < 0 ? u + 1 : u, std::atan2(std::hypot(d.x, d.y), d.z) / pi};
}

}  // namespace

double fov_of(const Camera& camera) {
  const auto* perspective = std::get_if<PerspectiveProjection>(&camera.projection);
  return perspective ? perspective->fov : 0;
}

std::array<double, 4> screen_window_of(const Camera& camera, const FilmSettings& film) {
  const double aspect =
      camera.frame_aspect_ratio.value_or(static_cast<double>(film.width) / film.height);
  const double x = std::max(aspect, 1.0), y = std::max(1 / aspect, 1.0);
  return camera.screen_window.value_or(std::array<double, 4>{-x, x, -y, y});
}

std::array<double, 4> image_plane_of(const Camera& camera, const FilmSettings& film) {
  std::array<double, 4> window = screen_window_of(camera, film);
  if (const auto* perspective = std::get_if<PerspectiveProjection>(&camera.projection))
    for (double& side : window) side *= std::tan(perspective->fov / 2);
  return window;
}

CameraRay unproject(const Camera& camera, const FilmSettings& film, const glm::dvec2& raster) {
  const glm::dvec2 uv = raster / glm::dvec2(film.width, film.height);
  if (const auto* spherical = std::get_if<SphericalProjection>(&camera.projection))
    return {glm::dvec3(0), spherical_direction(*spherical, uv)};
  const std::array<double, 4> plane = image_plane_of(camera, film);
  const double x = plane[0] + uv.x * (plane[1] - plane[0]),
               y = plane[3] + uv.y * (plane[2] - plane[3]);
  if (is_orthographic(camera)) return {{x, y, 0}, {0, 0, 1}};
  return {glm::dvec3(0), glm::normalize(glm::dvec3(x, y, 1))};
}

std::optional<glm::dvec2> project(const Camera& camera, const FilmSettings& film,
                                  const glm::dvec3& point) {
  const glm::dvec2 size(film.width, film.height);
  if (const auto* spherical = std::get_if<SphericalProjection>(&camera.projection)) {
    const double away = glm::length(point);
    if (!(away > 0)) return std::nullopt;
    return size * spherical_place(*spherical, point / away);
  }
  const std::array<double, 4> plane = image_plane_of(camera, film);
  glm::dvec2 at(point);
  if (!is_orthographic(camera)) {
    if (!(point.z > 0)) return std::nullopt;
    at /= point.z;
  }
  return size * glm::dvec2((at.x - plane[0]) / (plane[1] - plane[0]),
                           (at.y - plane[3]) / (plane[2] - plane[3]));
}

double pixel_footprint(const Camera& camera, const FilmSettings& film, const glm::dvec3& point) {
  const double unit = glm::length(glm::dvec3(camera.world_from_camera[0]));
  const glm::dvec3 to_point = point - glm::dvec3(camera.world_from_camera[3]);
  if (const auto* spherical = std::get_if<SphericalProjection>(&camera.projection)) {
    const double away = glm::length(to_point);
    if (spherical->mapping == SphericalProjection::Mapping::equal_area)
      return away * std::sqrt(4 * pi / (static_cast<double>(film.width) * film.height));
    const double up =
        away > 0
            ? glm::dot(to_point, glm::normalize(glm::dvec3(camera.world_from_camera[1]))) / away
            : 0;
    return away *
           std::min(pi / film.height, 2 * pi * std::sqrt(std::max(0.0, 1 - up * up)) / film.width);
  }
  const std::array<double, 4> plane = image_plane_of(camera, film);
  const double at_one =
      unit * std::min((plane[1] - plane[0]) / film.width, (plane[3] - plane[2]) / film.height);
  if (is_orthographic(camera)) return at_one;
  const glm::dvec3 forward(camera.world_from_camera[2]);
  const double depth = glm::dot(to_point, forward) / glm::dot(forward, forward);
  return depth > 0 ? at_one * depth : 0;
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
