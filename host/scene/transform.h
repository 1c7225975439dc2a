// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// What scene files may state of transforms and directions.
#pragma once

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <glm/vec3.hpp>
#include <limits>

namespace caplet {

/// Whether an affine matrix can be turned around, relative to its columns' lengths, so that small and uneven scales can: 1e-12
/// leaves four digits of a double.
inline bool has_inverse(const glm::dmat4& matrix) {
  const glm::dmat3 a(matrix);
  const double product = glm::length(a[0]) * glm::length(a[1]) * glm::length(a[2]);
  return std::abs(glm::determinant(a)) > 1e-12 * product && std::isfinite(product);
}

inline bool is_affine(const glm::dmat4& matrix) {
  return matrix[0][3] == 0 && matrix[1][3] == 0 && matrix[2][3] == 0 && matrix[3][3] == 1;
}

/// Whether a length is 1 but for rounding: what has it is of unit length as it is, and is not divided by it.
inline bool is_unit(double length) { return std::abs(length - 1) <= 4 * std::numeric_limits<double>::epsilon(); }

}  // namespace caplet
