// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include <array>
#include <map>
#include <span>

#include "scene/shape.h"

namespace caplet {

namespace {

using Corner = std::array<float, 3>;

/// Edges that an odd number of faces have, and all; corners in the order around each face.
class Edges {
 public:
  void add(std::span<const glm::vec3> around) {
    for (std::size_t i = 0; i < around.size(); ++i) {
      Corner a = corner(around[i]), b = corner(around[(i + 1) % around.size()]);
      if (a == b) continue;
      if (b < a) std::swap(a, b);
      ++faces_[{a, b}];
    }
  }
  double open() const {
    std::size_t odd = 0;
    for (const auto& [edge, faces] : faces_) odd += faces % 2 != 0;
    return faces_.empty() ? 1 : static_cast<double>(odd) / static_cast<double>(faces_.size());
  }

 private:
  static Corner corner(const glm::vec3& p) { return {p.x + 0.f, p.y + 0.f, p.z + 0.f}; }  // no -0
  std::map<std::pair<Corner, Corner>, int> faces_;
};

}  // namespace

double open_edges(const Shape& shape) {
  if (is_closed(shape)) return 0;
  Edges edges;
  if (const auto* mesh = std::get_if<TriangleMeshShape>(&shape.geometry))
    for (const auto& face : mesh->triangles)
      edges.add(std::array{mesh->positions[face[0]], mesh->positions[face[1]], mesh->positions[face[2]]});
  if (const auto* mesh = std::get_if<BilinearMeshShape>(&shape.geometry))
    for (const auto& face : mesh->patches)
      edges.add(
          std::array{mesh->positions[face[0]], mesh->positions[face[1]], mesh->positions[face[3]], mesh->positions[face[2]]});
  return edges.open();
}

}  // namespace caplet
