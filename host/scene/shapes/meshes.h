// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Meshes of triangles and of bilinear patches.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "scene/shapes/family.h"
#include "scene/shapes/shutter_keys.h"

namespace caplet {

/// Triangles. A mesh that moves has `times`, two or more that rise (seconds). Positions and normals
/// then hold all vertices at the first time, then all at the second one, and so on.
struct TriangleMeshShape {
  std::vector<glm::vec3> positions;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<glm::vec3> normals;  // empty or as many as positions
  std::vector<glm::vec2> uvs;      // empty or one per vertex
  std::vector<double> times = {};
};

/// Bilinear patches, an open shape. The corners of a patch are p00, p10, p01, p11 (pbrt's order).
struct BilinearMeshShape {
  std::vector<glm::vec3> positions;
  std::vector<std::array<std::uint32_t, 4>> patches;
  std::vector<glm::vec3> normals;  // empty or one per vertex
  std::vector<glm::vec2> uvs;      // empty or one per vertex
};

inline std::size_t vertex_count(const TriangleMeshShape& mesh) {
  return mesh.times.empty() ? mesh.positions.size() : mesh.positions.size() / mesh.times.size();
}
inline std::size_t vertex_count(const BilinearMeshShape& mesh) { return mesh.positions.size(); }

template <class Mesh>
void check_vertices(const Mesh& mesh, ShapeCheck& report) {
  const std::size_t count = mesh.positions.size(), vertices = vertex_count(mesh);
  if ((!mesh.normals.empty() && mesh.normals.size() != count) ||
      (!mesh.uvs.empty() && mesh.uvs.size() != vertices))
    return report.error("the mesh has another number of normals or uvs than of vertices");
  for (std::size_t i = 0; i < count; ++i) {
    const char* what = !is_finite(mesh.positions[i])                          ? "position"
                       : !mesh.normals.empty() && !is_finite(mesh.normals[i]) ? "normal"
                       : i < mesh.uvs.size() && !is_finite(mesh.uvs[i])       ? "uv"
                                                                              : nullptr;
    if (what)
      return report.error(std::string("the ") + what + " of vertex " +
                          std::to_string(i % vertices) + " of the mesh is not finite");
  }
}

template <class Faces>
void check_faces(const Faces& faces, std::size_t count, ShapeCheck& report) {
  for (const auto& face : faces)
    for (const std::uint32_t vertex : face)
      if (vertex >= count) {
        report.error("the mesh has the vertex index " + std::to_string(vertex) + ", but " +
                     std::to_string(count) + " vertices");
        break;
      }
}

template <class Mesh, class Faces>
Bounds bounds_of_faces(const Mesh& mesh, const Faces& faces, std::size_t first_vertex,
                       const glm::dmat4& m) {
  Bounds bounds;
  for (const auto& face : faces)
    for (const std::uint32_t vertex : face)
      bounds.extend(transformed(m, glm::dvec3(mesh.positions[first_vertex + vertex])));
  return bounds;
}

inline std::size_t count_of(const TriangleMeshShape& mesh) { return mesh.triangles.size(); }
inline std::size_t surfaces_of(const TriangleMeshShape&) { return 1; }
inline bool closed(const TriangleMeshShape&) { return false; }
inline Beyond beyond(const TriangleMeshShape&, const glm::dvec3&) { return unknown; }
/// Bounds it at all times.
inline Bounds bounds_under(const TriangleMeshShape& mesh, const glm::dmat4& m) {
  Bounds bounds;
  for (std::size_t key = 0; key < std::max<std::size_t>(1, mesh.times.size()); ++key)
    bounds.extend(bounds_of_faces(mesh, mesh.triangles, key * vertex_count(mesh), m));
  return bounds;
}
inline void check(const TriangleMeshShape& mesh, ShapeCheck& report) {
  if (!check_key_times(mesh.times, mesh.positions.size(), report)) return;
  check_vertices(mesh, report);
  check_faces(mesh.triangles, vertex_count(mesh), report);
}
inline TriangleMeshShape drawn(std::type_identity<TriangleMeshShape>, Draws& draws) {
  TriangleMeshShape out{
      {draws.point(), draws.point(), draws.point(), draws.point()}, {{0, 1, 2}, {1, 2, 3}}, {}, {}};
  if (draws.one_in(2))
    out.positions[3] = out.positions[0] + static_cast<float>(draws.thin()) * draws.point();
  return out;
}

inline std::size_t count_of(const BilinearMeshShape& mesh) { return mesh.patches.size(); }
inline std::size_t surfaces_of(const BilinearMeshShape&) { return 1; }
inline bool closed(const BilinearMeshShape&) { return false; }
inline Beyond beyond(const BilinearMeshShape&, const glm::dvec3&) { return unknown; }
inline Bounds bounds_under(const BilinearMeshShape& mesh, const glm::dmat4& m) {
  return bounds_of_faces(mesh, mesh.patches, 0, m);
}
inline void check(const BilinearMeshShape& mesh, ShapeCheck& report) {
  check_vertices(mesh, report);
  check_faces(mesh.patches, mesh.positions.size(), report);
}
inline BilinearMeshShape drawn(std::type_identity<BilinearMeshShape>, Draws& draws) {
  return BilinearMeshShape{
      {draws.point(), draws.point(), draws.point(), draws.point(), draws.point(), draws.point()},
      {{0, 1, 2, 3}, {2, 3, 4, 5}},
      {},
      {}};
}

}  // namespace caplet
