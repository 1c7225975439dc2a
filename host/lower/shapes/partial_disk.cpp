// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include <glm/geometric.hpp>

#include "lower/detail/flat_shapes.h"
#include "lower/detail/shapes.h"

namespace caplet {

using glm::dvec3;
using Matrix = glm::dmat4;

FlatPrimitive flat_partial_disk(const DiskShape& disk) {
  FlatPrimitive p = make_primitive(shape_partial_disk);
  p.data[partial_disk_at_height] = static_cast<float>(disk.height);
  p.data[partial_disk_at_r] = static_cast<float>(disk.radius);
  p.data[partial_disk_at_inner] = static_cast<float>(disk.inner_radius);
  p.data[partial_disk_at_phi_max] = static_cast<float>(disk.phi_max);
  return p;
}

ExactBox partial_disk_box(const FlatPrimitive& p) {
  const double r = double(partial_disk_r(p.data)), z = double(partial_disk_height(p.data));
  return {{-r, -r, z}, {r, r, z}};
}

double partial_disk_area(const FlatPrimitive& p, const std::vector<float>&) {
  const float r = partial_disk_r(p.data), inner = partial_disk_inner(p.data);
  return 0.5 * partial_disk_phi_max(p.data) * (r * r - inner * inner);
}

void partial_disk_pieces(const FlatPrimitive& p, const std::vector<float>& leaves, Pieces& pieces) {
  pieces.flat(0, {0, 0, partial_disk_area(p, leaves)});
}

}  // namespace caplet
