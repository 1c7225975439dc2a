// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <limits>

#include "base/check.h"
#include "lower/detail/flat_shapes.h"
#include "lower/detail/shapes.h"

namespace caplet {

using glm::dvec3;
using Matrix = glm::dmat4;

namespace {

/// Rounds through memory: GCC 12 drops the rounding of a double to float and back where it
/// vectorises it.
double rounded_to_float(double x) {
  volatile float rounded = static_cast<float>(x);
  return rounded;
}

/// Writes a row for each plane (shapes.def). In the polyhedron's own space uv runs along the plane,
/// 1/2 at the foot of the perpendicular from the centre of the bounds, over a bounding radius to
/// either side. Its directions are those of +x and +y (-y) after the shortest rotation of +z (-z
/// for normals below -0.9) to the normal.
void put_plane_uvs(const PolyhedronShape& polyhedron, const std::vector<dvec3>& corners,
                   const Matrix& m, const dvec3& center, float* out) {
  Bounds box;
  for (const dvec3& corner : corners) box.extend(corner);
  const dvec3 own_center = 0.5 * (box.min + box.max);
  double radius = 0;
  for (const dvec3& corner : corners) radius = std::max(radius, glm::length(corner - own_center));
  const dvec3 from = apply_point(glm::inverse(m), center) - own_center;
  const glm::dmat3 gradients = glm::transpose(glm::inverse(glm::dmat3(m)));
  for (std::size_t i = 0; i < polyhedron.normals.size(); ++i) {
    const dvec3 n = glm::normalize(polyhedron.normals[i]);
    const double sign = n.z >= -0.9 ? 1 : -1,
                 a = -1 / (sign + n.z);  // Duff et al. 2017, as kernels/math/vector.cl
    const dvec3 directions[2] = {{1 + sign * n.x * n.x * a, sign * n.x * n.y * a, -sign * n.x},
                                 {n.x * n.y * a, sign + n.y * n.y * a, -n.y}};
    for (const dvec3& direction : directions) {
      const dvec3 along = direction / (2 * radius), gradient = gradients * along;
      for (int k = 0; k < 3; ++k) *out++ = static_cast<float>(gradient[k]);
      *out++ = static_cast<float>(0.5 + glm::dot(from, along));
    }
  }
}

/// Returns a vector along the normal, as long as the area is large.
dvec3 polygon_area(const std::vector<dvec3>& corners) {
  dvec3 sum(0);
  for (std::size_t i = 2; i < corners.size(); ++i)
    sum += glm::cross(corners[i - 1] - corners[0], corners[i] - corners[0]);
  return 0.5 * sum;
}

std::vector<std::vector<dvec3>> faces_of_polyhedron(const float* head) {
  PolyhedronShape planes;
  const auto count = std::bit_cast<std::uint32_t>(head[3]);
  for (std::uint32_t i = 0; i < count; ++i) {
    const float* plane = head + 8 + 4 * i;
    planes.normals.emplace_back(plane[0], plane[1], plane[2]);
    planes.points.push_back(double(plane[3]) * planes.normals.back());
  }
  return polyhedron_faces(planes);
}

double polyhedron_area(const float* head) {
  double area = 0;
  for (const auto& face : faces_of_polyhedron(head)) area += glm::length(polygon_area(face));
  return area;
}

const float* head_of(const FlatPrimitive& p, const std::vector<float>& leaves) {
  return &leaves[polyhedron_begin(p.data)];
}

}  // namespace

FlatPrimitive flat_primitive(const PolyhedronShape& polyhedron, const Matrix& m,
                             std::vector<float>& leaves) {
  // Planes are kept relative to the centre of the bounds, so that their rounding is relative to the
  // solid's size.
  const std::vector<dvec3> corners = polyhedron_corners(polyhedron);
  CHECK_LT_(std::size_t(0), corners.size());
  Bounds box;
  for (const dvec3& corner : corners) box.extend(apply_point(m, corner));
  dvec3 center;
  for (int k = 0; k < 3; ++k) center[k] = rounded_to_float(0.5 * (box.min[k] + box.max[k]));
  const glm::dmat3 normal_matrix = glm::transpose(glm::inverse(glm::dmat3(m)));
  const std::size_t count = polyhedron.points.size(), begin = (leaves.size() + 7) / 8 * 8;
  const std::size_t uv_begin = begin + 8 + (4 * count + 7) / 8 * 8;
  leaves.resize(uv_begin + 8 * count);
  float* out = &leaves[begin];
  for (int k = 0; k < 3; ++k) out[k] = static_cast<float>(center[k]);
  out[3] = std::bit_cast<float>(narrow<std::uint32_t>(count));
  double radius = 0;
  for (const dvec3& corner : corners)
    radius = std::max(radius, glm::length(apply_point(m, corner) - center));
  out[4] = std::nextafter(static_cast<float>(radius), std::numeric_limits<float>::infinity());
  for (std::size_t i = 0; i < count; ++i) {
    const dvec3 n = glm::normalize(normal_matrix * polyhedron.normals[i]);
    for (int k = 0; k < 3; ++k)
      out[8 + 4 * i + static_cast<std::size_t>(k)] = static_cast<float>(n[k]);
    out[8 + 4 * i + 3] =
        static_cast<float>(glm::dot(n, apply_point(m, polyhedron.points[i]) - center));
  }
  put_plane_uvs(polyhedron, corners, m, center, &leaves[uv_begin]);
  FlatPrimitive p = make_primitive(shape_polyhedron);
  p.data[polyhedron_at_begin] = std::bit_cast<float>(narrow<std::uint32_t>(begin));
  put(p, polyhedron_data, box.min);
  put(p, polyhedron_data + 3, box.max);
  return p;
}

bool bakes_under(const PolyhedronShape&, const Matrix&) { return true; }
glm::dmat3 turn_under(const PolyhedronShape&, const Matrix&) { return glm::dmat3(1); }

double polyhedron_area(const FlatPrimitive& p, const std::vector<float>& leaves) {
  return polyhedron_area(head_of(p, leaves));
}

void polyhedron_pieces(const FlatPrimitive& p, const std::vector<float>& leaves, Pieces& pieces) {
  const auto faces = faces_of_polyhedron(head_of(p, leaves));
  for (std::size_t i = 0; i < faces.size(); ++i)
    pieces.flat(static_cast<std::uint32_t>(i), polygon_area(faces[i]));
}

FlatPrimitive polyhedron_grown(FlatPrimitive p, double b, std::vector<float>& leaves) {
  const std::size_t from = polyhedron_begin(p.data), to = leaves.size();
  const std::size_t count = std::bit_cast<std::uint32_t>(leaves[from + 3]);
  leaves.resize(to + 8 + (4 * count + 7) / 8 * 8);
  std::copy_n(leaves.begin() + static_cast<std::ptrdiff_t>(from), 8 + 4 * count,
              leaves.begin() + static_cast<std::ptrdiff_t>(to));
  for (std::size_t i = 0; i < count; ++i) move_by(leaves[to + 8 + 4 * i + 3], 1, b);
  p.data[polyhedron_at_begin] = std::bit_cast<float>(narrow<std::uint32_t>(to));
  return p;
}

}  // namespace caplet
