// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Readers of triangle meshes and bilinear meshes.
#include <algorithm>
#include <functional>

#include "base/log.h"
#include "import/detail/pbrt/geometry.h"

namespace caplet::pbrt {

namespace {

/// Reads "times". Normals that are given once stay the same.
void read_times(Parameters& parameters, TriangleMeshShape& mesh) {
  mesh.times = key_times(parameters);
  const std::size_t times = mesh.times.size(), points = mesh.positions.size();
  if (times == 0) return;
  if (points % times != 0) {
    parameters.error("P", "has " + std::to_string(points) +
                              " points, which are not as many at each of " + std::to_string(times) +
                              " times");
    mesh.times.clear();
    return;
  }
  const std::size_t count = vertex_count(mesh);
  if (mesh.normals.size() == count)
    for (std::size_t i = 0; mesh.normals.size() < points; ++i)
      mesh.normals.push_back(mesh.normals[i]);
}

/// Reads "P", "N" and the uvs under any of their names, one entry per vertex; of meshes that move
/// "P" has one per vertex and time, and "N" may have.
template <class Mesh>
void read_vertices(Parameters& parameters, Mesh& mesh,
                   std::initializer_list<const char*> uv_names) {
  if (!parameters.has("P")) parameters.error("\"point3 P\" is missing");
  mesh.positions = vectors3(parameters, parameters.values("P", {"point3"}));
  mesh.normals = vectors3(parameters, parameters.values("N", {"normal"}));
  if constexpr (requires { mesh.times; }) read_times(parameters, mesh);
  const std::size_t count = vertex_count(mesh);
  const auto one_a_vertex = [&](const char* name, std::size_t given) {
    if (given != 0 && count != 0 && given != count)
      parameters.error(name, "has " + std::to_string(given) + " entries for " +
                                 std::to_string(count) + " vertices");
  };
  if (mesh.normals.size() != mesh.positions.size()) one_a_vertex("N", mesh.normals.size());
  for (const char* name : uv_names)
    if (const Parameter* uv = parameters.values(name, {"point2"})) {
      for (std::size_t i = 0; i + 1 < uv->numbers.size(); i += 2)
        mesh.uvs.emplace_back(to_float(parameters, name, uv->numbers[i]),
                              to_float(parameters, name, uv->numbers[i + 1]));
      one_a_vertex(name, mesh.uvs.size());
    }
}

/// Reads "indices" in groups of K. A mesh of K vertices needs none: it has one face with the
/// vertices in order.
template <std::size_t K>
std::vector<std::array<std::uint32_t, K>> read_indices(Parameters& parameters, std::size_t count) {
  std::vector<std::array<std::uint32_t, K>> faces;
  const Parameter* indices = parameters.values("indices", {"integer"});
  if (!indices) {
    if (parameters.has("indices") || count == 0) return faces;
    if (count != K) {
      parameters.error("\"integer indices\" is missing (only a mesh of " + std::to_string(K) +
                       " vertices needs none)");
      return faces;
    }
    faces.emplace_back();
    for (std::size_t k = 0; k < K; ++k) faces[0][k] = static_cast<std::uint32_t>(k);
    return faces;
  }
  const auto& n = indices->numbers;
  if (n.size() % K)
    parameters.error("indices", "takes a multiple of " + std::to_string(K) + " values, not " +
                                    std::to_string(n.size()));
  if (count == 0) return faces;
  faces.reserve(n.size() / K);
  for (std::size_t i = 0; i + K <= n.size(); i += K) {
    std::array<std::uint32_t, K>& face = faces.emplace_back();
    for (std::size_t k = 0; k < K; ++k) {
      if (n[i + k] < 0 || n[i + k] >= static_cast<double>(count)) {
        parameters.error("indices", "has the index " + std::to_string(static_cast<int>(n[i + k])) +
                                        " (entry " + std::to_string(i + k) + "), but there are " +
                                        std::to_string(count) + " vertices");
        faces.pop_back();
        return faces;
      }
      face[k] = static_cast<std::uint32_t>(n[i + k]);
    }
  }
  return faces;
}

}  // namespace

std::vector<double> key_times(Parameters& parameters) {
  const Parameter* given = parameters.values("times", {"float"});
  if (!given) return {};
  const std::vector<double>& times = given->numbers;
  if (times.size() >= 2 && std::ranges::adjacent_find(times, std::greater_equal()) == times.end())
    return times;
  parameters.error("times", times.size() < 2 ? "takes two times or more" : "must rise");
  return {};
}

TriangleMeshShape make_triangle_mesh(Parameters& parameters) {
  TriangleMeshShape mesh;
  if (parameters.has("uv") && parameters.has("st"))
    parameters.error("st", "cannot be combined with \"uv\"");
  read_vertices(parameters, mesh, {"uv", "st"});
  if (parameters.values("S", {"vector3"}))
    log::info("{}: \"S\" (tangents) has no effect and is ignored",
              parameters.where("S").to_string());
  parameters.values("faceIndices", {"integer"});
  mesh.triangles = read_indices<3>(parameters, vertex_count(mesh));
  return mesh;
}

TriangleMeshShape make_vertices_and_triangles(Parameters& parameters) {
  TriangleMeshShape mesh;
  if (!parameters.has("P")) parameters.error("\"point3 P\" is missing");
  mesh.positions = vectors3(parameters, parameters.values("P", {"point3"}));
  mesh.triangles = read_indices<3>(parameters, mesh.positions.size());
  return mesh;
}

BilinearMeshShape make_bilinear_mesh(Parameters& parameters) {
  BilinearMeshShape mesh;
  read_vertices(parameters, mesh, {"uv"});
  parameters.values("faceIndices", {"integer"});
  parameters.ignore(
      "emissionfilename");  // affects only sampling; emission comes from the light's own image
  mesh.patches = read_indices<4>(parameters, mesh.positions.size());
  return mesh;
}

}  // namespace caplet::pbrt
