// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Bounds and counts of the model.
#include "scene/scene.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "scene/detail/csg_bounds.h"

namespace caplet {

void Bounds::extend(const glm::dvec3& p) {
  min = glm::min(min, p);
  max = glm::max(max, p);
}

void Bounds::extend(const Bounds& other) {
  min = glm::min(min, other.min);
  max = glm::max(max, other.max);
}

namespace {

/// Half the extents of the unit ball's image under `a`: the lengths of its rows.
glm::dvec3 row_lengths(const glm::dmat3& a) {
  const glm::dmat3 rows = glm::transpose(a);
  return {glm::length(rows[0]), glm::length(rows[1]), glm::length(rows[2])};
}

void extend_box(Bounds& bounds, const glm::dvec3& center, const glm::dvec3& half) {
  bounds.extend(center - half);
  bounds.extend(center + half);
}

/// The greatest value of a.x cos(phi) + a.y sin(phi) for 0 <= phi <= phi_max.
double greatest_across(const glm::dvec3& a, double phi_max) {
  const double summit = std::atan2(a.y, a.x);
  if (phi_max >= full_turn || (summit < 0 ? summit + full_turn : summit) <= phi_max) return std::hypot(a.x, a.y);
  return std::max(a.x, a.x * std::cos(phi_max) + a.y * std::sin(phi_max));
}

struct BoundsOf {
  const glm::dmat4& m;

  glm::dvec3 point(const glm::dvec3& p) const { return glm::dvec3(m * glm::dvec4(p, 1)); }

  Bounds operator()(const SphereShape& sphere) const {
    Bounds bounds;
    extend_box(bounds, point(glm::dvec3(0)), sphere.radius * row_lengths(glm::dmat3(m)));
    return bounds;
  }
  Bounds operator()(const CapsulesShape& capsules) const {
    Bounds bounds;
    const glm::dvec3 unit = row_lengths(glm::dmat3(m));
    for (std::size_t i = 0; i < capsules.p0.size(); ++i) {
      const double r0 = static_cast<double>(capsules.radius0[i]);
      const double r1 = capsules.radius1.empty() ? r0 : static_cast<double>(capsules.radius1[i]);
      extend_box(bounds, point(glm::dvec3(capsules.p0[i])), r0 * unit);
      extend_box(bounds, point(glm::dvec3(capsules.p1[i])), r1 * unit);
    }
    return bounds;
  }
  Bounds operator()(const TriangleMeshShape& mesh) const {
    Bounds bounds;
    for (const auto& triangle : mesh.triangles)
      for (std::uint32_t vertex : triangle) bounds.extend(point(glm::dvec3(mesh.positions[vertex])));
    return bounds;
  }
  /// The hull of the ends: balls, or disks with normal n across the axis, whose image has half extents radius |row - (row.n) n|.
  Bounds ends(const glm::dvec3& p0, const glm::dvec3& p1, double radius0, double radius1, const std::array<Cap, 2>& caps) const {
    const glm::dmat3 a(m);
    const glm::dvec3 n = glm::normalize(p1 - p0), ball = row_lengths(a);
    glm::dvec3 disk;
    for (int k = 0; k < 3; ++k) {
      const glm::dvec3 row(a[0][k], a[1][k], a[2][k]);
      disk[k] = glm::length(row - glm::dot(row, n) * n);
    }
    Bounds bounds;
    extend_box(bounds, point(p0), radius0 * (caps[0] == Cap::round ? ball : disk));
    extend_box(bounds, point(p1), radius1 * (caps[1] == Cap::round ? ball : disk));
    return bounds;
  }
  Bounds operator()(const CylinderShape& c) const { return ends(c.p0, c.p1, c.radius, c.radius, c.caps); }
  Bounds operator()(const ConeShape& c) const { return ends(c.p0, c.p1, c.radius[0], c.radius[1], c.caps); }
  Bounds operator()(const BoxShape& box) const {
    Bounds bounds;
    for (int i = 0; i < 8; ++i)
      bounds.extend(point({i & 1 ? box.p1.x : box.p0.x, i & 2 ? box.p1.y : box.p0.y, i & 4 ? box.p1.z : box.p0.z}));
    return bounds;
  }
  Bounds operator()(const PolyhedronShape& polyhedron) const {
    Bounds bounds;
    for (const glm::dvec3& corner : polyhedron_corners(polyhedron)) bounds.extend(point(corner));
    return bounds;
  }
  /// Bounds from the greatest value of a.p over the points p of a shape, for each row a of the matrix and its opposite.
  template <class Greatest>
  Bounds along_rows(Greatest greatest) const {
    Bounds bounds;
    for (int k = 0; k < 3; ++k) {
      const glm::dvec3 row(m[0][k], m[1][k], m[2][k]);
      bounds.min[k] = m[3][k] - greatest(-row);
      bounds.max[k] = m[3][k] + greatest(row);
    }
    return bounds;
  }
  Bounds operator()(const PartialSphereShape& s) const {
    // At height z the sphere has the radius rho = sqrt(r^2 - z^2) and a.p is at most a_z z + across rho: concave in z, with its
    // summit at r a_z / |(across, a_z)|, where across >= 0; otherwise convex.
    return along_rows([&](const glm::dvec3& a) {
      const double across = greatest_across(a, s.phi_max);
      const auto at = [&](double z) { return a.z * z + across * std::sqrt(std::max(0.0, s.radius * s.radius - z * z)); };
      const double slope = std::hypot(across, a.z);
      if (across < 0 || slope == 0) return std::max(at(s.z_min), at(s.z_max));
      return at(std::clamp(s.radius * a.z / slope, s.z_min, s.z_max));
    });
  }
  Bounds operator()(const OpenCylinderShape& c) const {
    return along_rows(
        [&](const glm::dvec3& a) { return c.radius * greatest_across(a, c.phi_max) + std::max(a.z * c.z_min, a.z * c.z_max); });
  }
  Bounds operator()(const BilinearMeshShape& mesh) const {
    Bounds bounds;
    for (const auto& patch : mesh.patches)
      for (std::uint32_t vertex : patch) bounds.extend(point(glm::dvec3(mesh.positions[vertex])));
    return bounds;
  }
  Bounds operator()(const CsgShape& csg) const {
    Bounds bounds;
    for (std::size_t i = 0; i < csg.operands.size(); ++i) {
      if (csg.operation == CsgShape::Operation::set_difference && i > 0) break;
      const glm::dmat4 world_from_operand = m * csg.operands[i]->world_from_object;
      const Bounds own = std::visit(BoundsOf{world_from_operand}, csg.operands[i]->geometry);
      if (csg.operation == CsgShape::Operation::set_intersection && i > 0) {
        bounds.min = glm::max(bounds.min, own.min);
        bounds.max = glm::min(bounds.max, own.max);
      } else {
        bounds.extend(own);
      }
    }
    return tightened(csg, m, bounds);
  }
  Bounds operator()(const DiskShape& disk) const {
    return along_rows([&](const glm::dvec3& a) {
      const double across = greatest_across(a, disk.phi_max);
      return across * (across >= 0 ? disk.radius : disk.inner_radius) + a.z * disk.height;
    });
  }
};

struct CountOf {
  std::map<std::string, std::uint64_t>& counts;
  std::uint64_t times;

  void operator()(const SphereShape&) const { counts["sphere"] += times; }
  void operator()(const CapsulesShape& capsules) const { counts["capsule"] += times * capsules.p0.size(); }
  void operator()(const TriangleMeshShape& mesh) const { counts["triangle"] += times * mesh.triangles.size(); }
  void operator()(const DiskShape&) const { counts["disk"] += times; }
  void operator()(const CylinderShape&) const { counts["cylinder"] += times; }
  void operator()(const ConeShape&) const { counts["cone"] += times; }
  void operator()(const BoxShape&) const { counts["box"] += times; }
  void operator()(const PolyhedronShape&) const { counts["polyhedron"] += times; }
  void operator()(const PartialSphereShape&) const { counts["sphere"] += times; }
  void operator()(const OpenCylinderShape&) const { counts["cylinder"] += times; }
  void operator()(const BilinearMeshShape& mesh) const { counts["bilinear_patch"] += times * mesh.patches.size(); }
  void operator()(const CsgShape&) const { counts["csg"] += times; }
};

}  // namespace

namespace {

struct SurfacesOf {
  std::size_t operator()(const SphereShape&) const { return 1; }
  std::size_t operator()(const CapsulesShape&) const { return 1; }
  std::size_t operator()(const TriangleMeshShape&) const { return 1; }
  std::size_t operator()(const DiskShape&) const { return 1; }
  std::size_t operator()(const CylinderShape&) const { return 3; }
  std::size_t operator()(const ConeShape&) const { return 3; }
  std::size_t operator()(const BoxShape&) const { return 6; }
  std::size_t operator()(const PolyhedronShape& polyhedron) const { return polyhedron.points.size(); }
  std::size_t operator()(const PartialSphereShape&) const { return 1; }
  std::size_t operator()(const OpenCylinderShape&) const { return 1; }
  std::size_t operator()(const BilinearMeshShape&) const { return 1; }
  std::size_t operator()(const CsgShape& csg) const {
    std::size_t count = 0;
    for (const auto& operand : csg.operands) count += surface_count(*operand);
    return count;
  }
};

struct IsClosed {
  bool operator()(const SphereShape&) const { return true; }
  bool operator()(const CapsulesShape&) const { return true; }
  bool operator()(const TriangleMeshShape&) const { return false; }
  bool operator()(const DiskShape&) const { return false; }
  bool operator()(const CylinderShape& c) const { return c.caps[0] != Cap::open && c.caps[1] != Cap::open; }
  bool operator()(const ConeShape& c) const { return c.caps[0] != Cap::open && c.caps[1] != Cap::open; }
  bool operator()(const BoxShape&) const { return true; }
  bool operator()(const PolyhedronShape&) const { return true; }
  bool operator()(const PartialSphereShape&) const { return false; }
  bool operator()(const OpenCylinderShape&) const { return false; }
  bool operator()(const BilinearMeshShape&) const { return false; }
  bool operator()(const CsgShape&) const { return true; }
};

}  // namespace

std::size_t surface_count(const Shape& shape) { return std::visit(SurfacesOf{}, shape.geometry); }

bool is_closed(const Shape& shape) { return std::visit(IsClosed{}, shape.geometry); }

std::size_t solid_count(const Shape& shape) {
  const auto* csg = std::get_if<CsgShape>(&shape.geometry);
  if (!csg) return 1;
  std::size_t count = 0;
  for (const auto& operand : csg->operands) {
    count += solid_count(*operand);
    if (count > max_csg_operands) break;
  }
  return count;
}

Bounds bounds_of(const Shape& shape) { return std::visit(BoundsOf{shape.world_from_object}, shape.geometry); }

Bounds bounds_of(const Scene& scene) {
  Bounds bounds;
  for (const Shape& shape : scene.shapes) bounds.extend(bounds_of(shape));
  for (const Instance& instance : scene.instances)
    for (const Shape& shape : scene.objects[instance.object].shapes) {
      const glm::dmat4 world_from_shape = instance.world_from_object * shape.world_from_object;
      bounds.extend(std::visit(BoundsOf{world_from_shape}, shape.geometry));
    }
  return bounds;
}

std::map<std::string, std::uint64_t> count_primitives(const Scene& scene) {
  std::map<std::string, std::uint64_t> counts;
  for (const Shape& shape : scene.shapes) std::visit(CountOf{counts, 1}, shape.geometry);
  std::vector<std::uint64_t> uses(scene.objects.size(), 0);
  for (const Instance& instance : scene.instances) ++uses[instance.object];
  for (std::size_t i = 0; i < uses.size(); ++i)
    for (const Shape& shape : scene.objects[i].shapes)
      if (uses[i] > 0) std::visit(CountOf{counts, uses[i]}, shape.geometry);
  return counts;
}

}  // namespace caplet
