// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <numbers>

#include "lower/detail/flat_shapes.h"
#include "lower/detail/shapes.h"

namespace caplet {

using glm::dvec3;
using Matrix = glm::dmat4;

namespace {

/// Returns the common scale of the plane z = 0 under `m` when circles in it stay circles; otherwise
/// 0.
double disk_scale(const Matrix& m) {
  const glm::dmat3 a(m);
  const double x = glm::length(a[0]), y = glm::length(a[1]), s = (x + y) / 2;
  return std::abs(x - y) <= 2e-6 * s && std::abs(glm::dot(a[0], a[1])) <= 2e-6 * s * s ? s : 0;
}

dvec3 disk_normal(const Matrix& m) {
  return glm::normalize(glm::transpose(glm::inverse(glm::dmat3(m))) * dvec3(0, 0, 1));
}

}  // namespace

FlatPrimitive flat_primitive(const DiskShape& disk, const Matrix& m, std::vector<float>&) {
  if (!disk.is_whole()) return flat_partial_disk(disk);
  FlatPrimitive p = make_primitive(shape_disk);
  put(p, disk_at_c, apply_point(m, dvec3(0, 0, disk.height)));
  put(p, disk_at_n, disk_normal(m));
  p.data[disk_at_r] = static_cast<float>(disk.radius * disk_scale(m));
  return p;
}

bool bakes_under(const DiskShape& disk, const Matrix& m) {
  return disk.is_whole() ? disk_scale(m) > 0 : m == Matrix(1);
}
glm::dmat3 turn_under(const DiskShape& disk, const Matrix& m) {
  return disk.is_whole()
             ? glm::dmat3(dvec3(m[0]) / disk_scale(m), dvec3(m[1]) / disk_scale(m), disk_normal(m))
             : glm::dmat3(1);
}

ExactBox disk_box(const FlatPrimitive& p) {
  ExactBox box;
  for (std::size_t k = 0; k < 3; ++k) {
    const double c = double(disk_c(p.data)[k]), n = double(disk_n(p.data)[k]);
    const double across = double(disk_r(p.data)) * std::sqrt(std::max(0.0, 1 - n * n));
    box.min[k] = c - across;
    box.max[k] = c + across;
  }
  return box;
}

double disk_area(const FlatPrimitive& p, const std::vector<float>&) {
  const float r = disk_r(p.data);
  return std::numbers::pi * r * r;
}

void disk_pieces(const FlatPrimitive& p, const std::vector<float>&, Pieces& pieces) {
  const float r = disk_r(p.data);
  pieces.flat(0, std::numbers::pi * r * r * point3(disk_n(p.data)));
}

}  // namespace caplet
