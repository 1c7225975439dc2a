// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "import/ply.h"

#include "base/log.h"
#include "import/pbrt_file.h"

#ifdef CAPLET_WITH_PLY
#include <assimp/scene.h>

#include <assimp/Importer.hpp>
#endif

namespace caplet {

#ifdef CAPLET_WITH_PLY

namespace {

TriangleMeshShape mesh_of(const std::string& file, const aiScene* scene, const ply::Header& header) {
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
  mesh.triangles.reserve(faces);
  std::uint64_t dropped = 0;
  for (std::uint64_t i = 0; i < faces; ++i) {
    const aiFace& face = from.mFaces[i];
    if (face.mNumIndices < 3) ++dropped;
    for (unsigned k = 2; k < face.mNumIndices; ++k)
      mesh.triangles.push_back({face.mIndices[0], face.mIndices[k - 1], face.mIndices[k]});
  }
  if (dropped) log::warn("{}: {} of {} faces have fewer than three corners and are left out", file, dropped, faces);
  if (mesh.triangles.empty()) throw InputError({file}, "the PLY file has no face with three corners");
  return mesh;
}

}  // namespace

TriangleMeshShape parse_ply(const std::string& file, const std::string& bytes) {
  const ply::Header header = ply::parse_header(file, bytes);
  const std::string plain = ply::rewrite(file, bytes, header);
  Assimp::Importer importer;
  return mesh_of(file, importer.ReadFileFromMemory(plain.data(), plain.size(), 0, "ply"), header);
}

#else

TriangleMeshShape parse_ply(const std::string& file, const std::string&) {
  throw InputError({file}, "this build cannot read PLY meshes (CAPLET_WITH_PLY is off)");
}

#endif

TriangleMeshShape read_ply(const std::filesystem::path& path, const SourceLocation& where) {
  return parse_ply(path.string(), pbrt::read_file(path, where));
}

}  // namespace caplet
