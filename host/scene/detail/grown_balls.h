// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Balls made larger by the radius of a probe: its centre may be outside of them.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <vector>

#include "scene/detail/point_grid.h"

namespace caplet {

/// A ball whose sphere meets that of the ball at hand.
struct NearBall {
  std::uint32_t ball;
  double radius;
  glm::dvec3 to;    // from the center at hand
  glm::dvec3 unit;  // the direction of `to`
  double height;    // of the spheres' circle over the center at hand, along unit
};

/// The balls with the probe's radius added. They are numbered without those that others swallow.
class GrownBalls {
 public:
  GrownBalls(std::span<const glm::vec3> centers, std::span<const float> radii, double probe);

  std::size_t size() const { return centers_.size(); }
  const glm::dvec3& center(std::uint32_t ball) const { return centers_[ball]; }
  double radius(std::uint32_t ball) const { return radii_[ball]; }
  /// The caller's number of a ball.
  std::uint32_t name(std::uint32_t ball) const { return names_[ball]; }
  double probe() const { return probe_; }

  /// Returns the ball `b` as seen from `a`, unless their spheres do not meet.
  std::optional<NearBall> seen(std::uint32_t a, std::uint32_t b) const;
  /// Returns all balls that meet `ball`. Those that cover more of it come first.
  std::vector<NearBall> around(std::uint32_t ball) const;

 private:
  bool swallowed(std::uint32_t ball) const;
  void keep(const std::vector<char>& dropped);

  double probe_;
  std::vector<glm::dvec3> centers_;
  std::vector<double> radii_;
  std::vector<std::uint32_t> names_;
  std::optional<PointGrid> grid_;
};

}  // namespace caplet
