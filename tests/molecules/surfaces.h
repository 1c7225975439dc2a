// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// What meshes of a ribbon enclose, and whether they are whole.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <map>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "scene/shape.h"

namespace caplet::test {

/// The number of edges between two places that triangles pass more often in one direction than in
/// the other: 0 for a closed surface whose triangles are turned alike.
inline std::size_t open_edges_of(std::span<const TriangleMeshShape> meshes) {
  using Place = std::tuple<float, float, float>;
  std::map<std::pair<Place, Place>, int> passed;
  for (const TriangleMeshShape& mesh : meshes)
    for (const auto& triangle : mesh.triangles)
      for (std::size_t k = 0; k < 3; ++k) {
        // Adding 0 makes -0 and 0 one place.
        const glm::vec3 a = mesh.positions[triangle.at(k)] + 0.0F,
                        b = mesh.positions[triangle.at((k + 1) % 3)] + 0.0F;
        const Place from{a.x, a.y, a.z}, to{b.x, b.y, b.z};
        if (from < to)
          ++passed[{from, to}];
        else
          --passed[{to, from}];
      }
  return static_cast<std::size_t>(
      std::ranges::count_if(passed, [](const auto& edge) { return edge.second != 0; }));
}

/// The number of normals that are not of length 1, within the rounding of three floats, and of
/// triangles that look away from the normals of their corners.
inline std::size_t unsound_normals(std::span<const TriangleMeshShape> meshes) {
  std::size_t out = 0;
  for (const TriangleMeshShape& mesh : meshes) {
    for (const glm::vec3& n : mesh.normals)
      out += std::abs(glm::length(glm::dvec3(n)) - 1) > 2e-7 ? 1 : 0;
    for (const auto& [a, b, c] : mesh.triangles) {
      const glm::dvec3 at(mesh.positions[a]),
          face = glm::cross(glm::dvec3(mesh.positions[b]) - at, glm::dvec3(mesh.positions[c]) - at),
          mean = glm::dvec3(mesh.normals[a]) + glm::dvec3(mesh.normals[b]) +
                 glm::dvec3(mesh.normals[c]);
      out += glm::dot(face, mean) <= 0 ? 1 : 0;
    }
  }
  return out;
}

/// The volume that closed meshes enclose; negative where they look inward.
inline double volume(std::span<const TriangleMeshShape> meshes) {
  double out = 0;
  for (const TriangleMeshShape& mesh : meshes)
    for (const auto& [a, b, c] : mesh.triangles)
      out += glm::dot(glm::dvec3(mesh.positions[a]),
                      glm::cross(glm::dvec3(mesh.positions[b]), glm::dvec3(mesh.positions[c]))) /
             6;
  return out;
}

}  // namespace caplet::test
