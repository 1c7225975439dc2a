// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include <algorithm>
#include <glm/geometric.hpp>

#include "lower/detail/flat_shapes.h"
#include "lower/detail/shapes.h"

namespace caplet {

using glm::dvec3;
using Matrix = glm::dmat4;

FlatPrimitive flat_primitive(const PartialSphereShape& s, const Matrix&, std::vector<float>&) {
  FlatPrimitive p = make_primitive(shape_partial_sphere);
  p.data[partial_sphere_at_r] = static_cast<float>(s.radius);
  p.data[partial_sphere_at_z_min] = static_cast<float>(s.z_min);
  p.data[partial_sphere_at_z_max] = static_cast<float>(s.z_max);
  p.data[partial_sphere_at_phi_max] = static_cast<float>(s.phi_max);
  return p;
}

bool bakes_under(const PartialSphereShape&, const Matrix& m) { return m == Matrix(1); }
glm::dmat3 turn_under(const PartialSphereShape&, const Matrix&) { return glm::dmat3(1); }

ExactBox partial_sphere_box(const FlatPrimitive& p) {
  const double r = double(partial_sphere_r(p.data));
  return {{-r, -r, double(partial_sphere_z_min(p.data))},
          {r, r, double(partial_sphere_z_max(p.data))}};
}

double partial_sphere_area(const FlatPrimitive& p, const std::vector<float>&) {
  const float r = partial_sphere_r(p.data);
  return partial_sphere_phi_max(p.data) * r *
         (std::min(partial_sphere_z_max(p.data), r) - std::max(partial_sphere_z_min(p.data), -r));
}

void partial_sphere_pieces(const FlatPrimitive& p, const std::vector<float>&, Pieces& pieces) {
  const double r = partial_sphere_r(p.data);
  pieces.part(Piece::zone, r * r, std::max<double>(partial_sphere_z_min(p.data), -r) / r,
              std::min<double>(partial_sphere_z_max(p.data), r) / r,
              partial_sphere_phi_max(p.data));
}

}  // namespace caplet
