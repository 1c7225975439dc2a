// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

namespace caplet {

/// The eigenvalues of a symmetric matrix, in no order, and their unit eigenvectors as the columns
/// of a rotation.
struct PrincipalAxes {
  glm::dvec3 values{0};
  glm::dmat3 world_from_axes{1};
};

/// Uses cyclic Jacobi rotations (Golub and Van Loan, Matrix Computations, 8.5).
PrincipalAxes principal_axes(glm::dmat3 symmetric);

}  // namespace caplet
