// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "lower/detail/flat_shapes.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include "base/check.h"
#include "lower/detail/shapes.h"

namespace caplet {

namespace {

using Matrix = glm::dmat4;
using glm::dvec3;

}  // namespace

dvec3 apply_point(const Matrix& m, const dvec3& p) { return dvec3(m * glm::dvec4(p, 1)); }

void put(FlatPrimitive& p, int at, const dvec3& v) {
  for (int k = 0; k < 3; ++k) p.data[at + k] = static_cast<float>(v[k]);
}

double similarity_scale(const Matrix& m) {
  const glm::dmat3 a(m);
  const double x = glm::length(a[0]), y = glm::length(a[1]), z = glm::length(a[2]);
  const double s = (x + y + z) / 3;
  // Scene files state rotations to six or seven digits: an angle error of 1e-6 moves a surface by
  // less than a float's rounding of it.
  const double slack = 2e-6 * s;
  const bool equal =
      std::abs(x - s) <= slack && std::abs(y - s) <= slack && std::abs(z - s) <= slack;
  const bool orthogonal = std::abs(glm::dot(a[0], a[1])) <= slack * s &&
                          std::abs(glm::dot(a[0], a[2])) <= slack * s &&
                          std::abs(glm::dot(a[1], a[2])) <= slack * s;
  return equal && orthogonal ? s : 0;
}

glm::dmat3 turn_of_similarity(const Matrix& m) { return glm::dmat3(m) / similarity_scale(m); }

std::uint32_t append_uv_space(const Geometry& geometry, const Matrix& m,
                              std::vector<float>& leaves) {
  const glm::dmat3 turn = std::visit([&](const auto& own) { return turn_under(own, m); }, geometry);
  double differs = 0;
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r)
      differs = std::max(differs, std::abs(turn[c][r] - (r == c ? 1 : 0)));
  if (differs <= 0x1p-24) return CAPLET_NONE;
  const std::size_t begin = (leaves.size() + 7) / 8 * 8;
  leaves.resize(begin + 16);
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c)
      leaves[begin + static_cast<std::size_t>(4 * r + c)] = static_cast<float>(turn[c][r]);
  return narrow<std::uint32_t>(begin);
}

bool bakes(const Shape& shape) {
  return std::visit(
      [&](const auto& geometry) { return bakes_under(geometry, shape.world_from_object); },
      shape.geometry);
}

}  // namespace caplet
