// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include <algorithm>
#include <glm/geometric.hpp>
#include <numbers>

#include "lower/detail/flat_shapes.h"
#include "lower/detail/shapes.h"

namespace caplet {

using glm::dvec3;
using Matrix = glm::dmat4;

FlatPrimitive flat_capsule(const CapsulesShape& capsules, std::size_t i, const Matrix* m,
                           double scale) {
  const auto placed = [m](const glm::vec3& v) { return m ? apply_point(*m, dvec3(v)) : dvec3(v); };
  const dvec3 p0 = placed(capsules.p0[i]), p1 = placed(capsules.p1[i]);
  const float r0 = capsules.radius0[i], r1 = capsules.radius1.empty() ? r0 : capsules.radius1[i];
  if (capsules.p0[i] == capsules.p1[i]) {
    FlatPrimitive p = make_primitive(shape_sphere);
    put(p, sphere_at_c, p0);
    p.data[sphere_at_r] = static_cast<float>(std::max(r0, r1) * scale);
    return p;
  }
  if (r0 == r1) {
    FlatPrimitive p = make_primitive(shape_capsule);
    put(p, capsule_at_p0, p0);
    put(p, capsule_at_p1, p1);
    p.data[capsule_at_r] = static_cast<float>(r0 * scale);
    return p;
  }
  FlatPrimitive p = make_primitive(shape_tapered_capsule);
  put(p, tapered_capsule_at_p0, p0);
  put(p, tapered_capsule_at_p1, p1);
  p.data[tapered_capsule_at_r0] = static_cast<float>(r0 * scale);
  p.data[tapered_capsule_at_r1] = static_cast<float>(r1 * scale);
  return p;
}

bool bakes_under(const CapsulesShape& capsules, const Matrix& m) {
  // Those that move keep their own space, where they are to the bit what they are at one time.
  return capsules.times.empty() ? similarity_scale(m) > 0 : m == Matrix(1);
}
glm::dmat3 turn_under(const CapsulesShape&, const Matrix& m) { return turn_of_similarity(m); }

ExactBox capsule_box(const FlatPrimitive& p) {
  const HullEnd end{double(capsule_r(p.data)), CAPLET_CAP_ROUND};
  return hull_box(capsule_p0(p.data), capsule_p1(p.data), end, end);
}

double capsule_area(const FlatPrimitive& p, const std::vector<float>&) {
  const float r = capsule_r(p.data);
  return 2 * std::numbers::pi * r * length3(capsule_p0(p.data), capsule_p1(p.data)) +
         4 * std::numbers::pi * r * r;
}

void capsule_pieces(const FlatPrimitive& p, const std::vector<float>&, Pieces& pieces) {
  pieces.balls(capsule_p0(p.data), capsule_p1(p.data), capsule_r(p.data), capsule_r(p.data),
               {0, 0, 0});
}

FlatPrimitive capsule_grown(FlatPrimitive p, double b, std::vector<float>&) {
  move_by(p.data[capsule_at_r], 1, b);
  return p;
}

}  // namespace caplet
