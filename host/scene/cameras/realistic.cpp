// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "scene/cameras/realistic.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace caplet {

std::array<double, 4> RealisticProjection::plane(const glm::dvec2& film, double diagonal) const {
  const glm::dvec2 half = film * (0.0005 * diagonal / glm::length(film));
  return {-half.x, half.x, -half.y, half.y};
}

std::optional<FocusedLens> RealisticProjection::focused(std::string& problem) const {
  return FocusedLens::of(lens ? lens->elements : plain_lens(), aperture_diameter, focus_distance,
                         problem);
}

std::vector<float> RealisticProjection::table(double diagonal) const {
  constexpr std::size_t pupil_count = 64;  // pbrt-v4's
  std::string problem;
  const auto lens_in_focus = focused(problem);
  if (!lens_in_focus) return {};
  const double most = 0.0005 * diagonal;
  std::vector<double> out = {static_cast<double>(lens_in_focus->surfaces().size()),
                             lens_in_focus->rear_z(),
                             static_cast<double>(pupil_count),
                             static_cast<double>(pupil_count) / most,
                             1 / lens_in_focus->image_distance(),
                             aperture ? static_cast<double>(aperture->width) : 0.0,
                             aperture ? static_cast<double>(aperture->height) : 0.0,
                             0.0};
  for (const FocusedLens::Surface& of : lens_in_focus->surfaces())
    out.insert(out.end(), {of.radius, of.z, of.eta, of.half});
  for (const FocusedLens::Pupil& of : lens_in_focus->pupils(most, pupil_count))
    out.insert(out.end(), {of.x0, of.x1, of.y0, of.y1});
  std::vector<float> floats(out.begin(), out.end());
  if (aperture) floats.insert(floats.end(), aperture->values.begin(), aperture->values.end());
  return floats;
}

CameraRay RealisticProjection::ray(const glm::dvec2& place) const {
  std::string problem;
  const auto lens_in_focus = focused(problem);
  if (!lens_in_focus) return {};
  const double r = glm::length(place);
  const CameraRay out = lens_in_focus->chief_ray(-r);
  const glm::dvec2 outward = r > 0 ? place / r : glm::dvec2(1, 0);
  return {glm::dvec3(outward * out.origin.x, out.origin.z),
          glm::dvec3(outward * out.direction.x, out.direction.z)};
}

std::optional<glm::dvec2> RealisticProjection::place(const glm::dvec3& point) const {
  std::string problem;
  const auto lens_in_focus = focused(problem);
  if (!lens_in_focus) return std::nullopt;
  const double across = std::hypot(point.x, point.y);
  // How far outside a chief ray passes the point.
  const auto beyond = [&](double r) {
    const CameraRay ray = lens_in_focus->chief_ray(-r);
    const double t = (point.z - ray.origin.z) / ray.direction.z;
    return t >= 0 ? ray.origin.x + t * ray.direction.x - across : -HUGE_VAL;
  };
  if (!(point.z > lens_in_focus->surfaces().back().z)) return std::nullopt;
  if (!(across > 0)) return glm::dvec2(0);
  // The places of the pinhole are near, so the search begins there.
  double low = 0, high = lens_in_focus->image_distance() * across /
                         std::max(point.z - lens_in_focus->principal_z(), 1e-9);
  for (int doublings = 0; !(beyond(high) > 0); ++doublings, high *= 2) {
    if (doublings == 8) return std::nullopt;
    low = high;
  }
  for (int halvings = 0; halvings < 60; ++halvings) {
    const double middle = (low + high) / 2;
    (beyond(middle) > 0 ? high : low) = middle;
  }
  return glm::dvec2(point) * (low / across);
}

double RealisticProjection::footprint(const glm::dvec3& point, const glm::dvec2& pixel) const {
  std::string problem;
  const auto lens_in_focus = focused(problem);
  if (!lens_in_focus) return 0;
  return std::max(0.0, point.z - lens_in_focus->principal_z()) * std::min(pixel.x, pixel.y) /
         lens_in_focus->image_distance();
}

}  // namespace caplet
