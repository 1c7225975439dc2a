// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Transforms that change while the shutter is open, as kernels read them (math/motion.cl): cubics
// in time, few enough to be stored and near enough that their error is one of rounding.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <glm/mat4x4.hpp>
#include <optional>
#include <span>
#include <vector>

#include "scene/bounds.h"
#include "scene/scene.h"

namespace caplet {

/// MotionPath is the transform of a thing while the shutter is open, at times from 0 to 1.
class MotionPath {
 public:
  /// Returns the path of `keys` while the shutter of `film` is open; no value if nothing moves
  /// then. `pivot`: AnimatedTransform's. Each matrix is multiplied by `right` from the right.
  /// Throws InputError, with the place, if the path takes more than 4,096 segments: where a thing
  /// turns about a point 10^8 times its size away.
  static std::optional<MotionPath> of(const TransformKeys& keys, const FilmSettings& film,
                                      const glm::dvec3& pivot = glm::dvec3(0),
                                      const glm::dmat4& right = glm::dmat4(1),
                                      const SourceLocation& where = {});

  /// Returns the path of a thing that is at at(seconds), whose speed changes at `times` (seconds)
  /// alone.
  static std::optional<MotionPath> of(const std::function<glm::dmat4(double)>& at,
                                      const std::vector<double>& times, const FilmSettings& film,
                                      const SourceLocation& where);

  std::uint32_t segments() const { return static_cast<std::uint32_t>(segments_.size()); }
  /// Returns the matrix at time 0.
  const glm::dmat4& start() const { return start_; }
  /// Returns bounds of the absolute values of the entries of the matrices, or of their inverses.
  glm::dmat4 greatest(bool of_inverse) const;
  /// Returns a box of all places of a box that moves, from one time to another.
  Bounds swept(const Bounds& box, float begin = 0, float end = 1) const;
  /// Appends the path as kernels read it; `with_inverse`: the inverse matrices first.
  void append(bool with_inverse, std::vector<float>& to) const;

 private:
  using Cubic = std::array<glm::dmat4, 4>;  // coefficients, of powers of u in [0, 1]
  struct Segment {
    double begin, end;
    Cubic matrix, inverse;
  };
  glm::dmat4 start_{1};
  std::vector<Segment> segments_;
};

/// Returns matrix number `matrix` of `matrices` of a path that was appended, at a time in [0, 1]:
/// 3 rows of 4, to the bit what kernels compute.
std::array<float, 12> motion_at(std::span<const float> motion, std::uint32_t segments,
                                std::uint32_t matrices, std::uint32_t matrix, float time);

}  // namespace caplet
