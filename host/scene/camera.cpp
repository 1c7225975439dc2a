// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "scene/camera.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "scene/film.h"

namespace caplet {

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
  return std::visit(
      [&](const auto& of) -> std::array<double, 4> {
        if constexpr (requires { of.plane(glm::dvec2(), 0.0); })
          return of.plane({film.width, film.height}, film.diagonal);
        if (!of.has_window) return {0, 1, 1, 0};
        std::array<double, 4> window = screen_window_of(camera, film);
        for (double& side : window) side *= of.plane_scale();
        return window;
      },
      camera.projection);
}

CameraRay unproject(const Camera& camera, const FilmSettings& film, const glm::dvec2& raster) {
  const glm::dvec2 uv = raster / glm::dvec2(film.width, film.height);
  const std::array<double, 4> plane = image_plane_of(camera, film);
  const glm::dvec2 place(plane[0] + uv.x * (plane[1] - plane[0]),
                         plane[3] + uv.y * (plane[2] - plane[3]));
  return std::visit([&](const auto& of) { return of.ray(place); }, camera.projection);
}

std::optional<glm::dvec2> project(const Camera& camera, const FilmSettings& film,
                                  const glm::dvec3& point) {
  const auto place = std::visit([&](const auto& of) { return of.place(point); }, camera.projection);
  if (!place) return std::nullopt;
  const std::array<double, 4> plane = image_plane_of(camera, film);
  return glm::dvec2(film.width * (place->x - plane[0]) / (plane[1] - plane[0]),
                    film.height * (place->y - plane[3]) / (plane[2] - plane[3]));
}

double pixel_footprint(const Camera& camera, const FilmSettings& film, const glm::dvec3& point) {
  const double unit = glm::length(glm::dvec3(camera.world_from_camera[0]));
  const glm::dvec3 seen(glm::inverse(camera.world_from_camera) * glm::dvec4(point, 1));
  const std::array<double, 4> plane = image_plane_of(camera, film);
  const glm::dvec2 pixel(std::abs(plane[1] - plane[0]) / film.width,
                         std::abs(plane[3] - plane[2]) / film.height);
  return unit *
         std::visit([&](const auto& of) { return of.footprint(seen, pixel); }, camera.projection);
}

}  // namespace caplet
