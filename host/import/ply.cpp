// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "import/detail/ply.h"
#include "import/detail/mesh_file.h"

#include <algorithm>
#include <cmath>

#include "base/log.h"
#include "import/detail/gzip_file.h"

#ifdef CAPLET_WITH_PLY
#include <assimp/scene.h>

#include <assimp/Importer.hpp>
#endif

namespace caplet {

#ifdef CAPLET_WITH_PLY

namespace {

/// Some programs write normals that are NaN (0 / 0). Values that are not finite at any vertex are dropped.
template <class Vector>
void drop_unless_finite(std::vector<Vector>& values, const std::string& file, const char* what, const char* instead) {
  const auto finite = [](const Vector& v) {
    for (glm::length_t k = 0; k < v.length(); ++k)
      if (!std::isfinite(v[k])) return false;
    return true;
  };
  const auto bad = values.size() - static_cast<std::size_t>(std::count_if(values.begin(), values.end(), finite));
  if (bad == 0) return;
  log::warn("{}: {} of {} {} are not finite: {}", file, bad, values.size(), what, instead);
  values.clear();
}

TriangleMeshShape mesh_of(const std::string& file, const aiScene* scene, const ply::Header& header, const ply::Colors& given,
                          std::vector<glm::vec3>* colors) {
  const std::uint64_t vertices = header.elements[header.vertex].count, faces = header.elements[header.face].count;
  if (!scene || scene->mNumMeshes != 1 || scene->mMeshes[0]->mNumVertices != vertices || scene->mMeshes[0]->mNumFaces != faces)
    throw InputError({file}, "the PLY file could not be read (its mesh is not what its header promises)");
  const aiMesh& from = *scene->mMeshes[0];
  TriangleMeshShape mesh;
  mesh.positions.reserve(vertices);
  for (std::uint64_t i = 0; i < vertices; ++i)
    mesh.positions.emplace_back(from.mVertices[i].x, from.mVertices[i].y, from.mVertices[i].z);
  for (std::uint64_t i = 0; from.mNormals && i < vertices; ++i)
    mesh.normals.emplace_back(from.mNormals[i].x, from.mNormals[i].y, from.mNormals[i].z);
  for (std::uint64_t i = 0; from.mTextureCoords[0] && i < vertices; ++i)
    mesh.uvs.emplace_back(from.mTextureCoords[0][i].x, from.mTextureCoords[0][i].y);
  drop_unless_finite(mesh.normals, file, "normals", "geometric normals are used");
  drop_unless_finite(mesh.uvs, file, "texture coordinates", "those of a mesh without any are used");
  mesh.triangles.reserve(faces);
  std::uint64_t dropped = 0;
  std::vector<glm::vec3> places;
  for (std::uint64_t i = 0; i < faces; ++i) {
    const aiFace& face = from.mFaces[i];
    if (face.mNumIndices < 3) ++dropped;
    places.clear();
    for (unsigned k = 0; k < face.mNumIndices; ++k) places.push_back(mesh.positions[face.mIndices[k]]);
    // Quadrilaterals are split as in pbrt.
    const auto cut =
        face.mNumIndices == 4 ? std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}, {0, 2, 3}} : triangles_of(places);
    for (const auto& [a, b, c] : cut) {
      mesh.triangles.push_back({face.mIndices[a], face.mIndices[b], face.mIndices[c]});
      for (const std::uint32_t vertex : mesh.triangles.back()) {
        if (!given.of_vertices.empty()) colors->push_back(given.of_vertices[vertex]);
        if (!given.of_faces.empty()) colors->push_back(given.of_faces[i]);
      }
    }
  }
  if (dropped) log::warn("{}: {} of {} faces have fewer than three corners and are left out", file, dropped, faces);
  if (mesh.triangles.empty()) throw InputError({file}, "the PLY file has no face with three corners");
  return mesh;
}

}  // namespace

TriangleMeshShape parse_ply(const std::string& file, const std::string& bytes, std::vector<glm::vec3>* colors) {
  const ply::Header header = ply::parse_header(file, bytes);
  ply::Colors given;
  const std::string plain = ply::rewrite(file, bytes, header, colors ? &given : nullptr);
  Assimp::Importer importer;
  return mesh_of(file, importer.ReadFileFromMemory(plain.data(), plain.size(), 0, "ply"), header, given, colors);
}

#else

TriangleMeshShape parse_ply(const std::string& file, const std::string&, std::vector<glm::vec3>*) {
  throw InputError({file}, "this build cannot read PLY meshes (CAPLET_WITH_PLY is off)");
}

#endif

TriangleMeshShape read_ply(const std::filesystem::path& path, const SourceLocation& where, std::vector<glm::vec3>* colors) {
  return parse_ply(path.string(), read_file(path, where), colors);
}

}  // namespace caplet
