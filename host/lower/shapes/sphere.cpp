// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include <glm/geometric.hpp>
#include <numbers>

#include "lower/detail/flat_shapes.h"
#include "lower/detail/shapes.h"

namespace caplet {

using glm::dvec3;
using Matrix = glm::dmat4;

FlatPrimitive flat_primitive(const SphereShape& sphere, const Matrix& m, std::vector<float>&) {
  FlatPrimitive p = make_primitive(shape_sphere);
  put(p, sphere_at_c, apply_point(m, dvec3(0)));
  p.data[sphere_at_r] = static_cast<float>(sphere.radius * similarity_scale(m));
  return p;
}

bool bakes_under(const SphereShape&, const Matrix& m) { return similarity_scale(m) > 0; }
glm::dmat3 turn_under(const SphereShape&, const Matrix& m) { return turn_of_similarity(m); }

ExactBox sphere_box(const FlatPrimitive& p) {
  ExactBox box;
  for (std::size_t k = 0; k < 3; ++k) {
    const double c = double(sphere_c(p.data)[k]), r = double(sphere_r(p.data));
    box.min[k] = c - r;
    box.max[k] = c + r;
  }
  return box;
}

double sphere_area(const FlatPrimitive& p, const std::vector<float>&) {
  const float r = sphere_r(p.data);
  return 4 * std::numbers::pi * r * r;
}

void sphere_pieces(const FlatPrimitive& p, const std::vector<float>&, Pieces& pieces) {
  const float r = sphere_r(p.data);
  pieces.round(Piece::zone, 0, {0, 0, 1}, double(r) * r, -1, 1);
}

FlatPrimitive sphere_grown(FlatPrimitive p, double b, std::vector<float>&) {
  move_by(p.data[sphere_at_r], 1, b);
  return p;
}

}  // namespace caplet
