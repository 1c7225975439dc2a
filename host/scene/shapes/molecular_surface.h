// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The solvent-excluded surface of balls (Connolly, "Analytical molecular surface calculation", J.
// Appl. Cryst. 16, 1983), as pieces of spheres and tori.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "scene/bounds.h"

namespace caplet {

/// The pieces of a solvent-excluded surface. A probe is a ball of one radius that enters no ball of
/// the molecule; the surface bounds the points that no probe reaches. It is smooth but for edges
/// where probes overlap.
struct SurfacePatches {
  /// The points x with dot(normal, x - center) <= offset of a BallPatch's center.
  struct Plane {
    glm::dvec3 normal;  // unit
    double offset;
  };
  /// The part of a sphere that lies within planes[plane_begin ...]: of a ball of the molecule, or
  /// of a probe that touches three balls.
  struct BallPatch {
    glm::dvec3 center;
    double radius;
    std::uint32_t probe;  // 1: of a probe, so that the molecule lies outside the sphere; else 0
    std::uint32_t ball;   // the ball of the molecule that is nearest
    std::uint32_t plane_begin, plane_count;
    Bounds bounds;
  };
  /// The part of a torus over which the probe rolls around two balls. With y = cross(axis, start),
  /// its points are
  ///   center + (major + minor cos(theta)) (cos(phi) start + sin(phi) y) + minor sin(theta) axis,
  /// for 0 <= phi <= phi_max (at most 2 pi) and theta_min <= theta <= theta_max, where
  /// major + minor cos(theta) >= 0, theta is in (pi/2, 3 pi/2) and theta_max - theta_min < pi. The
  /// molecule lies outside the tube.
  struct TorusPatch {
    glm::dvec3 center, axis, start;  // axis and start are unit and orthogonal
    double major, minor, phi_max, theta_min, theta_max;
    std::uint32_t ball;
    Bounds bounds;
  };
  std::vector<Plane> planes;
  std::vector<BallPatch> balls;
  std::vector<TorusPatch> tori;
};

/// Computes the surface's patches. Each is that part whose nearest ball is `ball`: a torus is cut
/// in the middle between its two balls, and a probe's patch in three. Radii and the probe are
/// positive and finite, and there is a radius for each center. Throws InputError where a probe can
/// touch more than 4,096 others together with one ball.
SurfacePatches molecular_surface(std::span<const glm::vec3> centers, std::span<const float> radii,
                                 double probe);

}  // namespace caplet
