// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Bounds and counts of the model.
#include "scene/scene.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

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
  Bounds operator()(const DiskShape& disk) const {
    Bounds bounds;
    glm::dmat3 a(m);
    a[2] = glm::dvec3(0);
    extend_box(bounds, point(glm::dvec3(0, 0, disk.height)), disk.radius * row_lengths(a));
    return bounds;
  }
};

struct CountOf {
  std::map<std::string, std::uint64_t>& counts;
  std::uint64_t times;

  void operator()(const SphereShape&) const { counts["sphere"] += times; }
  void operator()(const CapsulesShape& capsules) const { counts["capsule"] += times * capsules.p0.size(); }
  void operator()(const TriangleMeshShape& mesh) const { counts["triangle"] += times * mesh.triangles.size(); }
  void operator()(const DiskShape&) const { counts["disk"] += times; }
};

}  // namespace

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
