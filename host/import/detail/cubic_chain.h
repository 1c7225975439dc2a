// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Converts cubic curves with radii to chains of tapered capsules.
#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "scene/shapes/ends.h"

namespace caplet {

/// Bezier control points x y z with the radius as w. The tube is the union of the balls, that is,
/// what a circle sweeps.
using CubicTube = std::array<glm::dvec4, 4>;

/// Adds the end points of the chords of consecutive cubics. The distance of each point of a curve
/// from its point on the chord, plus the difference of radii, is at most the tolerance: this bounds
/// the distance between the union of the curve's balls and the capsules.
class CubicChain {
 public:
  explicit CubicChain(CapsulesShape& out) : out_(out) {}
  void start(const glm::dvec4& p);
  /// u of the chords runs from u0 to u1 as the cubic's parameter runs from 0 to 1.
  void add(const CubicTube& c, double tolerance, double u0, double u1);

 private:
  struct Part {
    CubicTube c;
    double u0, u1;
  };
  void add(const Part& part, double tolerance, int depth);
  void add_chord(const glm::dvec4& to, double u);

  CapsulesShape& out_;
  glm::vec3 p_{0};
  float radius_ = 0, u_ = 0;
};

}  // namespace caplet
