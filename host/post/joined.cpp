// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "post/detail/joined.h"

#include <numeric>

namespace caplet::post {

namespace {

/// Returns whether the last vertex of a mesh is one of the other, with the same normal.
bool go_on(const TriangleMeshShape& a, const TriangleMeshShape& b) {
  if (a.positions.empty() || a.normals.empty() || b.normals.empty()) return false;
  const glm::vec3 place = a.positions.back(), normal = a.normals.back();
  for (std::size_t i = 0; i < b.positions.size(); ++i)
    if (b.positions[i] == place && b.normals[i] == normal) return true;
  return false;
}

/// Returns whether the last capsule ends where one of the others begins, with the same radius.
bool go_on(const CapsulesShape& a, const CapsulesShape& b) {
  if (a.p1.empty()) return false;
  const auto end_radius = [](const CapsulesShape& of, std::size_t i) {
    return of.radius1.empty() ? of.radius0[i] : of.radius1[i];
  };
  const std::size_t last = a.p1.size() - 1;
  for (std::size_t i = 0; i < b.p0.size(); ++i)
    if (b.p0[i] == a.p1[last] && b.radius0[i] == end_radius(a, last) && b.p1[i] != b.p0[i])
      return true;
  return false;
}

}  // namespace

std::vector<std::uint32_t> joined_objects(const std::vector<Shape>& shapes) {
  std::vector<std::uint32_t> groups(shapes.size());
  std::iota(groups.begin(), groups.end(), 0U);
  for (std::size_t i = 0; i + 1 < shapes.size(); ++i) {
    const Shape &a = shapes[i], &b = shapes[i + 1];
    if (a.world_from_object != b.world_from_object) continue;
    const auto *mesh = std::get_if<TriangleMeshShape>(&a.geometry),
               *next_mesh = std::get_if<TriangleMeshShape>(&b.geometry);
    const auto *tube = std::get_if<CapsulesShape>(&a.geometry),
               *next_tube = std::get_if<CapsulesShape>(&b.geometry);
    if ((mesh && next_mesh && go_on(*mesh, *next_mesh)) ||
        (tube && next_tube && go_on(*tube, *next_tube)))
      groups[i + 1] = groups[i];
  }
  return groups;
}

}  // namespace caplet::post
