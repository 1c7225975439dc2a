// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Divides surfaces into pieces whose images under affine maps have known areas.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <numbers>
#include <vector>

namespace caplet {

/// HullEnd is an end of a hull: a ball, a disk across the axis, or a rim. `cap`: CAPLET_CAP_*.
struct HullEnd {
  double radius;
  float cap;
};

/// These return areas of the hulls of two balls, and of two ends, `length` apart.
double two_balls_area(double length, double r0, double r1);
double hull_area(double length, const HullEnd& end0, const HullEnd& end1);

/// Piece is a part of a primitive's surface whose image has an area of its own kind. With d =
/// `axis` (unit), e(phi) is around it from `start`:
struct Piece {
  enum Kind {
    flat,  // of area and normal `axis` (not unit)
    side,  // of a cone or cylinder: area `amount`, normals low d + sqrt(1 - low^2) e(phi)
    zone  // of a sphere of squared radius `amount`: normals h d + sqrt(1 - h^2) e(phi), low <= h <=
          // high
  } kind;
  std::uint32_t surface;
  glm::dvec3 axis;
  double amount = 0, low = 0, high = 0, phi_max = 2 * std::numbers::pi;
  glm::dvec3 start{0};
};

class Pieces {
 public:
  const std::vector<Piece>& all() const { return all_; }

  /// Adds a flat piece. `area`: along the normal, as long as the area is large.
  void flat(std::uint32_t surface, const glm::dvec3& area);
  void round(Piece::Kind kind, std::uint32_t surface, const glm::dvec3& axis, double amount,
             double low, double high = 0);
  /// Adds a part around z, from +x up to phi_max.
  void part(Piece::Kind kind, double amount, double low, double high, double phi_max);
  /// Adds the pieces of two_balls_area, for balls at p0 and p1. `surfaces`: of the cone between
  /// them, and of each.
  void balls(const float* p0, const float* p1, double r0, double r1,
             const std::array<std::uint32_t, 3>& surfaces);
  /// Adds the pieces of hull_area, for ends at p0 and p1.
  void hull(const float* p0, const float* p1, const HullEnd& end0, const HullEnd& end1);

 private:
  void two_balls(const glm::dvec3& axis, double length, double r0, double r1,
                 const std::array<std::uint32_t, 3>& surfaces);
  void disk_and_ball(const glm::dvec3& axis, double length, const HullEnd& disk,
                     std::uint32_t disk_surface, double ball, std::uint32_t ball_surface);
  std::vector<Piece> all_;
};

}  // namespace caplet
