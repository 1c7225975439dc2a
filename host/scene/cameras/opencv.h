// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/mat2x2.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>

#include "scene/camera_ray.h"
#include "scene/field.h"

namespace caplet {

/// A pinhole with the intrinsics and the distortion of OpenCV's camera model (Brown 1966, rational
/// in the radius as Claus and Fitzgibbon 2005): what `calibrateCamera` finds. Pixels are as there,
/// (0, 0) the middle of the first one; y goes down in its formulas, and up in camera space.
struct OpencvProjection {
  double fx = 0, fy = 0;         // pixels; 0: the width, and fx
  double cx = -1, cy = -1;       // pixels; below 0: the middle
  double width = 0, height = 0;  // of the picture that these are pixels of; 0: the film's
  double k1 = 0, k2 = 0, k3 = 0, k4 = 0, k5 = 0, k6 = 0, p1 = 0, p2 = 0;

  static constexpr bool has_window = false, has_plane = false, is_parallel = false;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit.number({"fx", "focal length across; 0: the width", 0, no_limit, "pixels"}, self.fx);
    visit.number({"fy", "focal length down; 0: fx", 0, no_limit, "pixels"}, self.fy);
    visit.number(
        {"cx", "column of the principal point; below 0: the middle", -no_limit, no_limit, "pixels"},
        self.cx);
    visit.number(
        {"cy", "row of the principal point; below 0: the middle", -no_limit, no_limit, "pixels"},
        self.cy);
    visit.number(
        {"width", "of the picture that was calibrated; 0: the film's", 0, no_limit, "pixels"},
        self.width);
    visit.number(
        {"height", "of the picture that was calibrated; 0: the film's", 0, no_limit, "pixels"},
        self.height);
    visit.number({"k1", "radial distortion by the 2nd power"}, self.k1);
    visit.number({"k2", "radial distortion by the 4th power"}, self.k2);
    visit.number({"k3", "radial distortion by the 6th power"}, self.k3);
    visit.number({"k4", "what divides it, by the 2nd power"}, self.k4);
    visit.number({"k5", "what divides it, by the 4th power"}, self.k5);
    visit.number({"k6", "what divides it, by the 6th power"}, self.k6);
    visit.number({"p1", "tangential distortion, down"}, self.p1);
    visit.number({"p2", "tangential distortion, across"}, self.p2);
  }

  double plane_scale() const { return 1; }
  std::uint32_t mapping() const { return 0; }
  std::array<double, 8> distortion() const { return {k1, k2, k3, k4, k5, k6, p1, p2}; }
  /// Returns what the picture shows, as places: coordinates of the distorted image plane z = 1.
  /// `film`: its size in pixels.
  std::array<double, 4> plane(const glm::dvec2& film, double) const {
    const double w = width > 0 ? width : film.x, h = height > 0 ? height : film.y;
    const double across = fx > 0 ? fx : w, down = fy > 0 ? fy : across;
    const double x = cx >= 0 ? cx : (w - 1) / 2, y = cy >= 0 ? cy : (h - 1) / 2;
    return {(-0.5 - x) / across, (w - 0.5 - x) / across, -(h - 0.5 - y) / down, (0.5 + y) / down};
  }
  /// Where distortion folds the picture over, at its rim, the ray is that of the fold.
  CameraRay ray(const glm::dvec2& place) const {
    const glm::dvec2 seen = undistorted({place.x, -place.y});
    return {glm::dvec3(0), glm::normalize(glm::dvec3(seen.x, -seen.y, 1))};
  }
  /// A point beyond the fold is not seen.
  std::optional<glm::dvec2> place(const glm::dvec3& point) const {
    if (!(point.z > 0)) return std::nullopt;
    const glm::dvec2 at(point.x / point.z, -point.y / point.z);
    const glm::dvec2 out = distorted(at).place;
    if (!(glm::length(undistorted(out) - at) <= 1e-6 * (1 + glm::length(at)))) return std::nullopt;
    return glm::dvec2(out.x, -out.y);
  }
  double footprint(const glm::dvec3& point, const glm::dvec2& pixel) const {
    if (!(point.z > 0)) return 0;
    const double area = glm::determinant(distorted({point.x / point.z, -point.y / point.z}).slope);
    return point.z * std::min(pixel.x, pixel.y) / std::sqrt(std::max(area, 1e-6));
  }

 private:
  struct Distorted {
    glm::dvec2 place;
    glm::dmat2 slope;  // of the place by x and by y, a column each
  };
  Distorted distorted(const glm::dvec2& at) const {
    const double x = at.x, y = at.y, r2 = x * x + y * y;
    const double over = 1 + r2 * (k1 + r2 * (k2 + r2 * k3)),
                 under = 1 + r2 * (k4 + r2 * (k5 + r2 * k6)), radial = over / under;
    // By r2.
    const double slope =
        (k1 + r2 * (2 * k2 + 3 * r2 * k3) - radial * (k4 + r2 * (2 * k5 + 3 * r2 * k6))) / under;
    const double across = 2 * x * y * slope + 2 * (p1 * x + p2 * y);
    return {{x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x),
             y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y},
            glm::dmat2(radial + 2 * x * x * slope + 2 * p1 * y + 6 * p2 * x, across, across,
                       radial + 2 * y * y * slope + 6 * p1 * y + 2 * p2 * x)};
  }
  /// Returns whether the picture is turned over there, along one way or along both.
  static bool is_folded(const glm::dmat2& slope) {
    return !(glm::determinant(slope) > 0 && slope[0][0] + slope[1][1] > 0);
  }
  /// Inverts it by Newton's method, in steps that stay on this side of a fold.
  glm::dvec2 undistorted(const glm::dvec2& place) const {
    glm::dvec2 at(0);
    for (int i = 0; i < 100; ++i) {
      const Distorted now = distorted(at);
      glm::dvec2 step = glm::inverse(now.slope) * (place - now.place);
      int halvings = 0;
      while (is_folded(distorted(at + step).slope) && ++halvings < 60) step *= 0.5;
      if (halvings == 60) break;
      at += step;
      if (glm::length(step) <= 1e-15 * (1 + glm::length(at))) break;
    }
    return at;
  }
};

}  // namespace caplet
