// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include <glm/geometric.hpp>

#include "lower/detail/flat_shapes.h"
#include "lower/detail/shapes.h"

namespace caplet {

using glm::dvec3;
using Matrix = glm::dmat4;

FlatPrimitive flat_primitive(const OpenCylinderShape& s, const Matrix&, std::vector<float>&) {
  FlatPrimitive p = make_primitive(shape_open_cylinder);
  p.data[open_cylinder_at_r] = static_cast<float>(s.radius);
  p.data[open_cylinder_at_z_min] = static_cast<float>(s.z_min);
  p.data[open_cylinder_at_z_max] = static_cast<float>(s.z_max);
  p.data[open_cylinder_at_phi_max] = static_cast<float>(s.phi_max);
  return p;
}

bool bakes_under(const OpenCylinderShape&, const Matrix& m) { return m == Matrix(1); }
glm::dmat3 turn_under(const OpenCylinderShape&, const Matrix&) { return glm::dmat3(1); }

ExactBox open_cylinder_box(const FlatPrimitive& p) {
  const double r = double(open_cylinder_r(p.data));
  return {{-r, -r, double(open_cylinder_z_min(p.data))},
          {r, r, double(open_cylinder_z_max(p.data))}};
}

double open_cylinder_area(const FlatPrimitive& p, const std::vector<float>&) {
  return open_cylinder_phi_max(p.data) * open_cylinder_r(p.data) *
         (open_cylinder_z_max(p.data) - open_cylinder_z_min(p.data));
}

void open_cylinder_pieces(const FlatPrimitive& p, const std::vector<float>& leaves,
                          Pieces& pieces) {
  pieces.part(Piece::side, open_cylinder_area(p, leaves), 0, 0, open_cylinder_phi_max(p.data));
}

}  // namespace caplet
