// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Checks of the transforms and directions in scene files.
#pragma once

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <glm/vec3.hpp>
#include <limits>

namespace caplet {

/// Returns whether an affine matrix is invertible. The determinant is relative to the lengths of
/// the columns, so that small and uneven scales pass: 1e-12 leaves four digits of a double.
inline bool has_inverse(const glm::dmat4& matrix) {
  const glm::dmat3 a(matrix);
  const double product = glm::length(a[0]) * glm::length(a[1]) * glm::length(a[2]);
  return std::abs(glm::determinant(a)) > 1e-12 * product && std::isfinite(product);
}

inline bool is_affine(const glm::dmat4& matrix) {
  return matrix[0][3] == 0 && matrix[1][3] == 0 && matrix[2][3] == 0 && matrix[3][3] == 1;
}

/// Returns whether a matrix turns, mirrors, shifts and scales evenly, up to rounding.
inline bool is_similarity(const glm::dmat4& matrix) {
  const glm::dmat3 a(matrix), squares = glm::transpose(a) * a;
  const double size = squares[0][0];
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r)
      if (!(std::abs(squares[c][r] - (c == r ? size : 0)) <= 1e-9 * size)) return false;
  return true;
}

/// Returns whether a length is 1 up to rounding. Such a vector is used as it is, without
/// normalisation.
inline bool is_unit(double length) {
  return std::abs(length - 1) <= 4 * std::numeric_limits<double>::epsilon();
}

}  // namespace caplet
