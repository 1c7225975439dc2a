// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Meshes that robots name, in the coordinates of their files.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/reading.h"
#include "base/spelling.h"
#include "import/detail/gzip_file.h"
#include "import/detail/mesh_file.h"
#include "import/detail/ply.h"
#include "import/detail/robot.h"
#include "import/detail/text_file.h"

namespace caplet {

namespace {

/// Reads MuJoCo's .msh: four counts, then positions, normals, texture coordinates (from the top)
/// and triangles.
TriangleMeshShape parse_msh(const std::string& bytes, const std::string& file) {
  std::array<std::int32_t, 4> counts{};
  const auto fail = [&](const std::string& message) { throw InputError({file, 0, 0}, message); };
  if (bytes.size() < sizeof counts) fail("is no MSH file: it is too short");
  std::memcpy(counts.data(), bytes.data(), sizeof counts);
  const auto [vertices, normals, uvs, faces] = counts;
  if (vertices < 0 || normals < 0 || uvs < 0 || faces < 0)
    fail("is no MSH file: a count is negative");
  if ((normals != 0 && normals != vertices) || (uvs != 0 && uvs != vertices))
    fail("other numbers of normals or texture coordinates than of vertices");
  const std::uint64_t size =
      sizeof counts + 4 * (3 * std::uint64_t(vertices) + 3 * std::uint64_t(normals) +
                           2 * std::uint64_t(uvs) + 3 * std::uint64_t(faces));
  if (size != bytes.size())
    fail(fmt::format("its counts need {} bytes; the file has {}", size, bytes.size()));
  TriangleMeshShape mesh;
  const char* at = bytes.data() + sizeof counts;
  const auto take = [&at](auto& to, std::int32_t count) {
    to.resize(static_cast<std::size_t>(count));
    const std::size_t length = to.size() * sizeof(to[0]);
    if (length > 0) std::memcpy(to.data(), at, length);
    at += length;
  };
  take(mesh.positions, vertices);
  take(mesh.normals, normals);
  take(mesh.uvs, uvs);
  take(mesh.triangles, faces);
  for (glm::vec2& uv : mesh.uvs) uv.y = 1 - uv.y;
  for (const glm::vec3& p : mesh.positions)
    for (int k = 0; k < 3; ++k)
      if (!(std::abs(p[k]) <= largest_number)) fail("a vertex is not finite or out of range");
  for (const auto& triangle : mesh.triangles)
    for (const std::uint32_t vertex : triangle)
      if (vertex >= mesh.positions.size()) fail("a triangle has a vertex that is not there");
  return mesh;
}

constexpr std::string_view kEndings[] = {".stl", ".obj", ".msh", ".dae", ".ply", ".off"};

}  // namespace

std::string lower_case_ending(const std::filesystem::path& path) {
  return lower_case(path.extension().string());
}

bool is_mesh_file(const std::filesystem::path& path) {
  return std::ranges::find(kEndings, lower_case_ending(path)) != std::end(kEndings);
}

std::shared_ptr<const MeshParts> MeshFiles::read(const std::filesystem::path& path,
                                                 const SourceLocation& where) {
  check_may_read(path, where);
  std::shared_ptr<const MeshParts>& known = meshes_[path.string()];
  if (known) return known;
  const std::string ending = lower_case_ending(path), file = path.string();
  MeshParts parts;
  if (ending == ".obj") {
    parts = read_obj_meshes(path, where);
  } else if (ending == ".off") {
    parts.push_back(parse_off(read_file(path, where), file));
  } else if (ending == ".stl") {
    parts.push_back(parse_stl(read_file(path, where), file));
  } else if (ending == ".ply") {
    parts.push_back(read_ply(path, where));
  } else if (ending == ".msh") {
    parts.push_back(parse_msh(read_file(path, where), file));
  } else if (ending == ".dae") {
    parts = read_dae_meshes(path, where);
  } else {
    throw InputError(where, "the mesh '" + file + "' is of a format that is not read");
  }
  std::erase_if(parts, [](const TriangleMeshShape& part) { return part.triangles.empty(); });
  if (parts.empty()) throw InputError(where, "the mesh '" + file + "' holds no faces");
  return known = std::make_shared<const MeshParts>(std::move(parts));
}

}  // namespace caplet
