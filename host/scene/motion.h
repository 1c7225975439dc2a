// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Transforms that change with time.
#pragma once

#include <array>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <vector>

namespace caplet {

/// The transform of something that moves at one time (seconds).
struct TransformKey {
  double time = 0;
  glm::dmat4 matrix{1};
};

/// The transforms of something that moves, by rising times, two or more; none: it rests.
using TransformKeys = std::vector<TransformKey>;

/// Interpolates transforms as pbrt-v4's AnimatedTransform does: each is a stretch, then a rotation,
/// then a translation (Shoemake and Duff 1992, "Matrix animation and polar decomposition"). Between
/// keys the stretch is linear, the rotation takes the shorter way about one axis at an even speed,
/// and the pivot, a point of what moves, goes straight on. Before the first key and after the last
/// one nothing moves.
class AnimatedTransform {
 public:
  /// Takes affine matrices with an inverse, whose determinants have one sign.
  explicit AnimatedTransform(const TransformKeys& keys, const glm::dvec3& pivot = glm::dvec3(0));
  glm::dmat4 at(double time) const;

 private:
  struct Key {
    double time;
    glm::dvec3 translation;          // of the pivot
    std::array<double, 4> rotation;  // unit quaternion w, x, y, z, on the side of the one before
    glm::dmat3 stretch;
  };
  std::vector<Key> keys_;
  glm::dvec3 pivot_;
};

/// Moves all of a motion: `matrix` is multiplied from the left to each key.
void move(TransformKeys& keys, const glm::dmat4& matrix);

}  // namespace caplet
