// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Cubic curves with radii as chains of tapered capsules.
#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "scene/shapes/ends.h"

namespace caplet {

/// Bezier control points x y z and, as w, radii: the union of balls, or what a circle sweeps.
using CubicTube = std::array<glm::dvec4, 4>;

/// Adds the ends of the chords of cubics that go on from one to the next. No point of a curve is farther than the tolerance from
/// where it lies on its chord, the difference of radii added: so far at most the union of the curve's balls and the capsules are
/// apart.
class CubicChain {
 public:
  explicit CubicChain(CapsulesShape& out) : out_(out) {}
  void start(const glm::dvec4& p);
  /// The chords' u run from u0 to u1 as the cubic's parameter does from 0 to 1.
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
