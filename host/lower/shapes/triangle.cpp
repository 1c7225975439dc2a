// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include <algorithm>
#include <glm/geometric.hpp>

#include "lower/detail/flat_shapes.h"
#include "lower/detail/shapes.h"

namespace caplet {

using glm::dvec3;
using Matrix = glm::dmat4;

bool bakes_under(const TriangleMeshShape& mesh, const Matrix& m) {
  return mesh.times.empty() || m == Matrix(1);
}
glm::dmat3 turn_under(const TriangleMeshShape&, const Matrix&) { return glm::dmat3(1); }

ExactBox triangle_box(const FlatPrimitive& p) {
  ExactBox box;
  for (std::size_t k = 0; k < 3; ++k) {
    const double a = double(triangle_v0(p.data)[k]), b = double(triangle_v1(p.data)[k]),
                 c = double(triangle_v2(p.data)[k]);
    box.min[k] = std::min({a, b, c});
    box.max[k] = std::max({a, b, c});
  }
  return box;
}

double triangle_area(const FlatPrimitive& p, const std::vector<float>&) {
  const dvec3 a = point3(triangle_v0(p.data)), b = point3(triangle_v1(p.data)),
              c = point3(triangle_v2(p.data));
  return 0.5 * glm::length(glm::cross(b - a, c - a));
}

void triangle_pieces(const FlatPrimitive& p, const std::vector<float>&, Pieces& pieces) {
  const dvec3 a = point3(triangle_v0(p.data)), b = point3(triangle_v1(p.data)),
              c = point3(triangle_v2(p.data));
  pieces.flat(0, 0.5 * glm::cross(b - a, c - a));
}

}  // namespace caplet
