// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "scene/principal_axes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace caplet {
namespace {

// Eigenvalues and vectors of rational numbers: columns of `turn` are (2, 1, -2)/3, (-2, 2, -1)/3
// and (1, 2, 2)/3.
TEST(PrincipalAxes, AreThoseThatTheMatrixWasMadeOf) {
  const glm::dmat3 turn = glm::dmat3(2, 1, -2, -2, 2, -1, 1, 2, 2) / 3.0;
  const glm::dvec3 values(9, -18, 4.5);
  glm::dmat3 matrix(0);
  for (int k = 0; k < 3; ++k) matrix += values[k] * glm::outerProduct(turn[k], turn[k]);
  const PrincipalAxes found = principal_axes(matrix);
  // Some ten rotations, each rounded a few times, of numbers up to 18.
  constexpr double kBound = 100 * 18 * 2.3e-16;
  for (int k = 0; k < 3; ++k) {
    int here = 0;
    for (int i = 0; i < 3; ++i)
      if (std::abs(found.values[i] - values[k]) < 1) here = i;
    EXPECT_NEAR(found.values[here], values[k], kBound);
    EXPECT_NEAR(std::abs(glm::dot(found.world_from_axes[here], turn[k])), 1, kBound);
  }
  EXPECT_NEAR(glm::determinant(found.world_from_axes), 1, kBound);
}

TEST(PrincipalAxes, OfADiagonalMatrixAreThoseOfTheWorld) {
  const PrincipalAxes found = principal_axes(glm::dmat3(3, 0, 0, 0, 3, 0, 0, 0, -1));
  EXPECT_EQ(found.values, glm::dvec3(3, 3, -1));
  EXPECT_EQ(found.world_from_axes, glm::dmat3(1));
}

}  // namespace
}  // namespace caplet
