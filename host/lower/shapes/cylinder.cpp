// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include <glm/geometric.hpp>

#include "lower/detail/flat_shapes.h"
#include "lower/detail/shapes.h"

namespace caplet {

using glm::dvec3;
using Matrix = glm::dmat4;

namespace {

HullEnd cylinder_end0(const FlatPrimitive& p) {
  return {cylinder_r(p.data), cylinder_cap0(p.data)};
}
HullEnd cylinder_end1(const FlatPrimitive& p) {
  return {cylinder_r(p.data), cylinder_cap1(p.data)};
}

}  // namespace

FlatPrimitive flat_primitive(const CylinderShape& cylinder, const Matrix& m, std::vector<float>&) {
  FlatPrimitive p = make_primitive(shape_cylinder);
  put(p, cylinder_at_p0, apply_point(m, cylinder.p0));
  put(p, cylinder_at_p1, apply_point(m, cylinder.p1));
  p.data[cylinder_at_r] = static_cast<float>(cylinder.radius * similarity_scale(m));
  p.data[cylinder_at_cap0] = cap_number(cylinder.caps[0]);
  p.data[cylinder_at_cap1] = cap_number(cylinder.caps[1]);
  return p;
}

bool bakes_under(const CylinderShape&, const Matrix& m) { return similarity_scale(m) > 0; }
glm::dmat3 turn_under(const CylinderShape&, const Matrix& m) { return turn_of_similarity(m); }

ExactBox cylinder_box(const FlatPrimitive& p) {
  return hull_box(cylinder_p0(p.data), cylinder_p1(p.data), cylinder_end0(p), cylinder_end1(p));
}

double cylinder_area(const FlatPrimitive& p, const std::vector<float>&) {
  return hull_area(length3(cylinder_p0(p.data), cylinder_p1(p.data)), cylinder_end0(p),
                   cylinder_end1(p));
}

void cylinder_pieces(const FlatPrimitive& p, const std::vector<float>&, Pieces& pieces) {
  pieces.hull(cylinder_p0(p.data), cylinder_p1(p.data), cylinder_end0(p), cylinder_end1(p));
}

FlatPrimitive cylinder_grown(FlatPrimitive p, double b, std::vector<float>&) {
  const GrownHull grown =
      grown_hull(cylinder_p0(p.data), cylinder_p1(p.data), cylinder_end0(p), cylinder_end1(p), b);
  put(p, cylinder_at_p0, grown.p0);
  put(p, cylinder_at_p1, grown.p1);
  move_by(p.data[cylinder_at_r], 1, b);
  return p;
}

}  // namespace caplet
