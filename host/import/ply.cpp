// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "import/detail/ply.h"
#include "import/detail/mesh_file.h"

#include <algorithm>
#include <cmath>

#include "base/log.h"
#include "import/detail/gzip_file.h"

namespace caplet {

namespace {

/// Some programs write normals that are NaN (0 / 0). Values that are not finite at any vertex are
/// dropped.
template <class Vector>
void drop_unless_finite(std::vector<Vector>& values, const std::string& file, const char* what,
                        const char* instead) {
  const auto finite = [](const Vector& v) {
    for (glm::length_t k = 0; k < v.length(); ++k)
      if (!std::isfinite(v[k])) return false;
    return true;
  };
  const auto bad =
      values.size() - static_cast<std::size_t>(std::count_if(values.begin(), values.end(), finite));
  if (bad == 0) return;
  log::warn("{}: {} of {} {} are not finite: {}", file, bad, values.size(), what, instead);
  values.clear();
}

/// Triangulates the faces. `colors` receives those of corners where the body has colours.
void add_triangles(const std::string& file, const ply::Body& body, TriangleMeshShape& mesh,
                   std::vector<glm::vec3>* colors) {
  mesh.triangles.reserve(body.lengths.size());
  std::uint64_t dropped = 0;
  std::vector<glm::vec3> places;
  const std::uint32_t* corners = body.corners.data();
  for (std::size_t face = 0; face < body.lengths.size(); corners += body.lengths[face++]) {
    const std::uint32_t length = body.lengths[face];
    if (length < 3) ++dropped;
    places.clear();
    for (std::uint32_t k = 0; k < length; ++k) places.push_back(mesh.positions[corners[k]]);
    // Quadrilaterals are split as in pbrt.
    const auto cut = length == 4 ? std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}, {0, 2, 3}}
                                 : triangles_of(places);
    for (const auto& [a, b, c] : cut) {
      mesh.triangles.push_back({corners[a], corners[b], corners[c]});
      for (const std::uint32_t vertex : mesh.triangles.back()) {
        if (!body.vertex_colors.empty()) colors->push_back(body.vertex_colors[vertex]);
        if (!body.face_colors.empty()) colors->push_back(body.face_colors[face]);
      }
    }
  }
  if (dropped)
    log::warn("{}: {} of {} faces have fewer than three corners and are left out", file, dropped,
              body.lengths.size());
  if (mesh.triangles.empty())
    throw InputError({file}, "the PLY file has no face with three corners");
}

}  // namespace

TriangleMeshShape parse_ply(const std::string& file, const std::string& bytes,
                            std::vector<glm::vec3>* colors) {
  ply::Body body = ply::read_body(file, bytes, ply::parse_header(file, bytes), colors != nullptr);
  TriangleMeshShape mesh;
  mesh.positions = std::move(body.positions);
  mesh.normals = std::move(body.normals);
  mesh.uvs = std::move(body.uvs);
  drop_unless_finite(mesh.normals, file, "normals", "geometric normals are used");
  drop_unless_finite(mesh.uvs, file, "texture coordinates", "those of a mesh without any are used");
  add_triangles(file, body, mesh, colors);
  return mesh;
}

TriangleMeshShape read_ply(const std::filesystem::path& path, const SourceLocation& where,
                           std::vector<glm::vec3>* colors) {
  return parse_ply(path.string(), read_file(path, where), colors);
}

}  // namespace caplet
