// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "lower/flat_shapes.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <limits>
#include <numbers>

#include "base/check.h"
#include "shared/kinds.h"

namespace caplet {

namespace {

using Matrix = glm::dmat4;
using glm::dvec3;

/// The common scale of the plane z = 0 under `m` when circles in it stay circles; otherwise 0.
double disk_scale(const Matrix& m) {
  const glm::dmat3 a(m);
  const double x = glm::length(a[0]), y = glm::length(a[1]), s = (x + y) / 2;
  return std::abs(x - y) <= 2e-6 * s && std::abs(glm::dot(a[0], a[1])) <= 2e-6 * s * s ? s : 0;
}

dvec3 disk_normal(const Matrix& m) { return glm::normalize(glm::transpose(glm::inverse(glm::dmat3(m))) * dvec3(0, 0, 1)); }

/// Boxes along the axes stay so under scales and moves; their surfaces keep their numbers under positive ones.
bool keeps_boxes(const Matrix& m) {
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r)
      if (r == c ? !(m[c][r] > 0) : m[c][r] != 0) return false;
  return true;
}

FlatPrimitive make(int shape) { return FlatPrimitive{static_cast<std::uint32_t>(shape), 0, {}}; }

float cap_number(Cap cap) { return cap == Cap::flat ? CAPLET_CAP_FLAT : cap == Cap::round ? CAPLET_CAP_ROUND : CAPLET_CAP_OPEN; }

FlatPrimitive of_quadric(int shape, double radius, double z_min, double z_max, double phi_max) {
  FlatPrimitive p = make(shape);
  const double values[] = {radius, z_min, z_max, phi_max};
  std::transform(std::begin(values), std::end(values), p.data, [](double x) { return static_cast<float>(x); });
  return p;
}

/// Through memory: GCC 12 drops the rounding of a double to float and back where it vectorises it.
double rounded_to_float(double x) {
  volatile float rounded = static_cast<float>(x);
  return rounded;
}

struct BakesOf {
  const Matrix& m;

  bool operator()(const TriangleMeshShape&) const { return true; }
  bool operator()(const BilinearMeshShape&) const { return true; }
  bool operator()(const PolyhedronShape&) const { return true; }
  bool operator()(const CsgShape&) const { return true; }
  bool operator()(const DiskShape& disk) const { return disk.is_whole() ? disk_scale(m) > 0 : m == Matrix(1); }
  bool operator()(const BoxShape&) const { return keeps_boxes(m); }
  bool operator()(const PartialSphereShape&) const { return m == Matrix(1); }
  bool operator()(const OpenCylinderShape&) const { return m == Matrix(1); }
  bool operator()(const SphereShape&) const { return similarity_scale(m) > 0; }
  bool operator()(const CapsulesShape&) const { return similarity_scale(m) > 0; }
  bool operator()(const CylinderShape&) const { return similarity_scale(m) > 0; }
  bool operator()(const ConeShape&) const { return similarity_scale(m) > 0; }
};

}  // namespace

dvec3 apply_point(const Matrix& m, const dvec3& p) { return dvec3(m * glm::dvec4(p, 1)); }

void put(FlatPrimitive& p, int at, const dvec3& v) {
  for (int k = 0; k < 3; ++k) p.data[at + k] = static_cast<float>(v[k]);
}

double similarity_scale(const Matrix& m) {
  const glm::dmat3 a(m);
  const double x = glm::length(a[0]), y = glm::length(a[1]), z = glm::length(a[2]);
  const double s = (x + y + z) / 3;
  // Scene files carry rotations to six or seven digits: an angle error of 1e-6 moves a surface by less than a float's rounding of
  // it.
  const double slack = 2e-6 * s;
  const bool equal = std::abs(x - s) <= slack && std::abs(y - s) <= slack && std::abs(z - s) <= slack;
  const bool orthogonal = std::abs(glm::dot(a[0], a[1])) <= slack * s && std::abs(glm::dot(a[0], a[2])) <= slack * s &&
                          std::abs(glm::dot(a[1], a[2])) <= slack * s;
  return equal && orthogonal ? s : 0;
}

namespace {

/// The rotation or reflection in `m`, of shapes whose uv has angles around an axis.
struct TurnOf {
  const Matrix& m;

  glm::dmat3 similar() const { return glm::dmat3(m) / similarity_scale(m); }
  glm::dmat3 operator()(const SphereShape&) const { return similar(); }
  glm::dmat3 operator()(const CapsulesShape&) const { return similar(); }
  glm::dmat3 operator()(const CylinderShape&) const { return similar(); }
  glm::dmat3 operator()(const ConeShape&) const { return similar(); }
  glm::dmat3 operator()(const DiskShape& disk) const {
    return disk.is_whole() ? glm::dmat3(dvec3(m[0]) / disk_scale(m), dvec3(m[1]) / disk_scale(m), disk_normal(m)) : glm::dmat3(1);
  }
  template <class Other>
  glm::dmat3 operator()(const Other&) const {
    return glm::dmat3(1);
  }
};

}  // namespace

std::uint32_t append_uv_space(const decltype(Shape::geometry)& geometry, const Matrix& m, std::vector<float>& leaves) {
  const glm::dmat3 turn = std::visit(TurnOf{m}, geometry);
  double differs = 0;
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r) differs = std::max(differs, std::abs(turn[c][r] - (r == c ? 1 : 0)));
  if (differs <= 0x1p-24) return CAPLET_NONE;
  const std::size_t begin = (leaves.size() + 7) / 8 * 8;
  leaves.resize(begin + 16);
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) leaves[begin + static_cast<std::size_t>(4 * r + c)] = static_cast<float>(turn[c][r]);
  return narrow<std::uint32_t>(begin);
}

bool bakes(const Shape& shape) { return std::visit(BakesOf{shape.world_from_object}, shape.geometry); }

FlatPrimitive flat_primitive(const SphereShape& sphere, const Matrix& m, std::vector<float>&) {
  FlatPrimitive p = make(shape_sphere);
  put(p, 0, apply_point(m, dvec3(0)));
  p.data[3] = static_cast<float>(sphere.radius * similarity_scale(m));
  return p;
}

FlatPrimitive flat_primitive(const DiskShape& disk, const Matrix& m, std::vector<float>&) {
  if (!disk.is_whole()) return of_quadric(shape_partial_disk, disk.height, disk.radius, disk.inner_radius, disk.phi_max);
  FlatPrimitive p = make(shape_disk);
  put(p, 0, apply_point(m, dvec3(0, 0, disk.height)));
  put(p, 3, disk_normal(m));
  p.data[6] = static_cast<float>(disk.radius * disk_scale(m));
  return p;
}

FlatPrimitive flat_primitive(const CylinderShape& cylinder, const Matrix& m, std::vector<float>&) {
  FlatPrimitive p = make(shape_cylinder);
  put(p, 0, apply_point(m, cylinder.p0));
  put(p, 3, apply_point(m, cylinder.p1));
  p.data[6] = static_cast<float>(cylinder.radius * similarity_scale(m));
  p.data[7] = cap_number(cylinder.caps[0]);
  p.data[8] = cap_number(cylinder.caps[1]);
  return p;
}

FlatPrimitive flat_primitive(const ConeShape& cone, const Matrix& m, std::vector<float>&) {
  FlatPrimitive p = make(shape_cone);
  const double scale = similarity_scale(m);
  put(p, 0, apply_point(m, cone.p0));
  put(p, 3, apply_point(m, cone.p1));
  p.data[6] = static_cast<float>(cone.radius[0] * scale);
  p.data[7] = static_cast<float>(cone.radius[1] * scale);
  p.data[8] = cap_number(cone.caps[0]);
  p.data[9] = cap_number(cone.caps[1]);
  return p;
}

FlatPrimitive flat_primitive(const BoxShape& box, const Matrix& m, std::vector<float>&) {
  FlatPrimitive p = make(shape_box);
  put(p, 0, apply_point(m, glm::min(box.p0, box.p1)));
  put(p, 3, apply_point(m, glm::max(box.p0, box.p1)));
  return p;
}

namespace {

/// A row a plane (shapes.def): in the polyhedron's own space uv runs along the plane, 1/2 at the foot of the perpendicular from
/// the centre of the bounds, over a bounding radius to either side; from the directions that turning +z (-z for normals below
/// -0.9) onto the normal the short way takes +x and +y (-y) to.
void put_plane_uvs(const PolyhedronShape& polyhedron, const std::vector<dvec3>& corners, const Matrix& m, const dvec3& center,
                   float* out) {
  Bounds box;
  for (const dvec3& corner : corners) box.extend(corner);
  const dvec3 own_center = 0.5 * (box.min + box.max);
  double radius = 0;
  for (const dvec3& corner : corners) radius = std::max(radius, glm::length(corner - own_center));
  const dvec3 from = apply_point(glm::inverse(m), center) - own_center;
  const glm::dmat3 gradients = glm::transpose(glm::inverse(glm::dmat3(m)));
  for (std::size_t i = 0; i < polyhedron.normals.size(); ++i) {
    const dvec3 n = glm::normalize(polyhedron.normals[i]);
    const double sign = n.z >= -0.9 ? 1 : -1, a = -1 / (sign + n.z);  // Duff et al. 2017, as kernels/math/vector.cl
    const dvec3 directions[2] = {{1 + sign * n.x * n.x * a, sign * n.x * n.y * a, -sign * n.x},
                                 {n.x * n.y * a, sign + n.y * n.y * a, -n.y}};
    for (const dvec3& direction : directions) {
      const dvec3 along = direction / (2 * radius), gradient = gradients * along;
      for (int k = 0; k < 3; ++k) *out++ = static_cast<float>(gradient[k]);
      *out++ = static_cast<float>(0.5 + glm::dot(from, along));
    }
  }
}

}  // namespace

FlatPrimitive flat_primitive(const PolyhedronShape& polyhedron, const Matrix& m, std::vector<float>& leaves) {
  // Planes are kept relative to the centre of the bounds, so that their rounding goes with the solid's size.
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
  for (const dvec3& corner : corners) radius = std::max(radius, glm::length(apply_point(m, corner) - center));
  out[4] = std::nextafter(static_cast<float>(radius), std::numeric_limits<float>::infinity());
  for (std::size_t i = 0; i < count; ++i) {
    const dvec3 n = glm::normalize(normal_matrix * polyhedron.normals[i]);
    for (int k = 0; k < 3; ++k) out[8 + 4 * i + static_cast<std::size_t>(k)] = static_cast<float>(n[k]);
    out[8 + 4 * i + 3] = static_cast<float>(glm::dot(n, apply_point(m, polyhedron.points[i]) - center));
  }
  put_plane_uvs(polyhedron, corners, m, center, &leaves[uv_begin]);
  FlatPrimitive p = make(shape_polyhedron);
  p.data[0] = std::bit_cast<float>(narrow<std::uint32_t>(begin));
  put(p, 3, box.min);
  put(p, 6, box.max);
  return p;
}

FlatPrimitive flat_primitive(const PartialSphereShape& s, const Matrix&, std::vector<float>&) {
  return of_quadric(shape_partial_sphere, s.radius, s.z_min, s.z_max, s.phi_max);
}

FlatPrimitive flat_primitive(const OpenCylinderShape& c, const Matrix&, std::vector<float>&) {
  return of_quadric(shape_open_cylinder, c.radius, c.z_min, c.z_max, c.phi_max);
}

}  // namespace caplet
