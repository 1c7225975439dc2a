// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "lower/detail/flat_shapes.h"
#include "lower/detail/shapes.h"

namespace caplet {

using glm::dvec3;
using Matrix = glm::dmat4;

FlatPrimitive flat_primitive(const BoxShape& box, const Matrix& m, std::vector<float>&) {
  FlatPrimitive p = make_primitive(shape_box);
  put(p, box_at_low, apply_point(m, glm::min(box.p0, box.p1)));
  put(p, box_at_high, apply_point(m, glm::max(box.p0, box.p1)));
  return p;
}

/// Boxes along the axes stay so under scales and moves; their surfaces keep their numbers under
/// positive ones.
bool bakes_under(const BoxShape&, const Matrix& m) {
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r)
      if (r == c ? !(m[c][r] > 0) : m[c][r] != 0) return false;
  return true;
}
glm::dmat3 turn_under(const BoxShape&, const Matrix&) { return glm::dmat3(1); }

ExactBox box_box(const FlatPrimitive& p) {
  ExactBox box;
  for (std::size_t k = 0; k < 3; ++k) {
    box.min[k] = double(box_low(p.data)[k]);
    box.max[k] = double(box_high(p.data)[k]);
  }
  return box;
}

double box_area(const FlatPrimitive& p, const std::vector<float>&) {
  const float *low = box_low(p.data), *high = box_high(p.data);
  const double x = high[0] - low[0], y = high[1] - low[1], z = high[2] - low[2];
  return 2 * (x * y + y * z + z * x);
}

void box_pieces(const FlatPrimitive& p, const std::vector<float>&, Pieces& pieces) {
  const dvec3 size = point3(box_high(p.data)) - point3(box_low(p.data));
  for (std::uint32_t face = 0; face < 6; ++face) {
    const int k = static_cast<int>(face / 2);
    dvec3 area(0);
    area[k] = size[(k + 1) % 3] * size[(k + 2) % 3];
    pieces.flat(face, area);
  }
}

FlatPrimitive box_grown(FlatPrimitive p, double b, std::vector<float>&) {
  for (int k = 0; k < 3; ++k) {
    move_by(p.data[box_at_low + k], -1, b);
    move_by(p.data[box_at_high + k], 1, b);
  }
  return p;
}

}  // namespace caplet
