// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include <glm/geometric.hpp>

#include "lower/detail/flat_shapes.h"
#include "lower/detail/shapes.h"

namespace caplet {

using glm::dvec3;
using Matrix = glm::dmat4;

ExactBox tapered_capsule_box(const FlatPrimitive& p) {
  return hull_box(tapered_capsule_p0(p.data), tapered_capsule_p1(p.data),
                  {double(tapered_capsule_r0(p.data)), CAPLET_CAP_ROUND},
                  {double(tapered_capsule_r1(p.data)), CAPLET_CAP_ROUND});
}

double tapered_capsule_area(const FlatPrimitive& p, const std::vector<float>&) {
  return two_balls_area(length3(tapered_capsule_p0(p.data), tapered_capsule_p1(p.data)),
                        tapered_capsule_r0(p.data), tapered_capsule_r1(p.data));
}

void tapered_capsule_pieces(const FlatPrimitive& p, const std::vector<float>&, Pieces& pieces) {
  pieces.balls(tapered_capsule_p0(p.data), tapered_capsule_p1(p.data), tapered_capsule_r0(p.data),
               tapered_capsule_r1(p.data), {0, 0, 0});
}

FlatPrimitive tapered_capsule_grown(FlatPrimitive p, double b, std::vector<float>&) {
  move_by(p.data[tapered_capsule_at_r1], 1, b);
  move_by(p.data[tapered_capsule_at_r0], 1, b);
  return p;
}

}  // namespace caplet
