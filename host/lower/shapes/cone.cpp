// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include <glm/geometric.hpp>

#include "lower/detail/flat_shapes.h"
#include "lower/detail/shapes.h"

namespace caplet {

using glm::dvec3;
using Matrix = glm::dmat4;

namespace {

HullEnd cone_end0(const FlatPrimitive& p) { return {cone_r0(p.data), cone_cap0(p.data)}; }
HullEnd cone_end1(const FlatPrimitive& p) { return {cone_r1(p.data), cone_cap1(p.data)}; }

}  // namespace

FlatPrimitive flat_primitive(const ConeShape& cone, const Matrix& m, std::vector<float>&) {
  FlatPrimitive p = make_primitive(shape_cone);
  const double scale = similarity_scale(m);
  put(p, cone_at_p0, apply_point(m, cone.p0));
  put(p, cone_at_p1, apply_point(m, cone.p1));
  p.data[cone_at_r0] = static_cast<float>(cone.radius[0] * scale);
  p.data[cone_at_r1] = static_cast<float>(cone.radius[1] * scale);
  p.data[cone_at_cap0] = cap_number(cone.caps[0]);
  p.data[cone_at_cap1] = cap_number(cone.caps[1]);
  return p;
}

bool bakes_under(const ConeShape&, const Matrix& m) { return similarity_scale(m) > 0; }
glm::dmat3 turn_under(const ConeShape&, const Matrix& m) { return turn_of_similarity(m); }

ExactBox cone_box(const FlatPrimitive& p) {
  return hull_box(cone_p0(p.data), cone_p1(p.data), cone_end0(p), cone_end1(p));
}

double cone_area(const FlatPrimitive& p, const std::vector<float>&) {
  return hull_area(length3(cone_p0(p.data), cone_p1(p.data)), cone_end0(p), cone_end1(p));
}

void cone_pieces(const FlatPrimitive& p, const std::vector<float>&, Pieces& pieces) {
  pieces.hull(cone_p0(p.data), cone_p1(p.data), cone_end0(p), cone_end1(p));
}

FlatPrimitive cone_grown(FlatPrimitive p, double b, std::vector<float>&) {
  const GrownHull grown =
      grown_hull(cone_p0(p.data), cone_p1(p.data), cone_end0(p), cone_end1(p), b);
  put(p, cone_at_p0, grown.p0);
  put(p, cone_at_p1, grown.p1);
  p.data[cone_at_r0] = static_cast<float>(grown.r0);
  p.data[cone_at_r1] = static_cast<float>(grown.r1);
  return p;
}

}  // namespace caplet
