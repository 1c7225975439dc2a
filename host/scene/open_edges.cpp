// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include <array>
#include <bit>
#include <cstdint>
#include <map>
#include <span>

#include "scene/shape.h"

namespace caplet {

namespace {

using Corner = std::array<float, 3>;

/// Counts all edges and those that belong to an odd number of faces. Corners are given in order
/// around each face.
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

/// Keeps the exclusive or of a hash of each edge of each face. An edge of an even number of faces
/// cancels itself.
class EdgeParity {
 public:
  void add(std::span<const glm::vec3> around) {
    for (std::size_t i = 0; i < around.size(); ++i) {
      const glm::vec3 &a = around[i], &b = around[(i + 1) % around.size()];
      if (a == b) continue;
      sum_ ^= mixed(hash(a) + hash(b));
      is_empty_ = false;
    }
  }
  bool is_even() const { return !is_empty_ && sum_ == 0; }

 private:
  /// The finaliser of SplitMix64 (Steele, Lea and Flood 2014).
  static std::uint64_t mixed(std::uint64_t x) {
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return x ^ (x >> 31);
  }
  static std::uint64_t hash(const glm::vec3& p) {
    std::uint64_t out = 0x9e3779b97f4a7c15u;
    for (int k = 0; k < 3; ++k)
      out = mixed(out + std::bit_cast<std::uint32_t>(p[k] + 0.f));  // no -0
    return out;
  }
  std::uint64_t sum_ = 0;
  bool is_empty_ = true;
};

/// Adds the faces of a mesh to `edges`, the corners of each in order around it.
template <class To>
void add_faces(const Shape& shape, To& edges) {
  if (const auto* mesh = std::get_if<TriangleMeshShape>(&shape.geometry))
    for (const auto& face : mesh->triangles)
      edges.add(
          std::array{mesh->positions[face[0]], mesh->positions[face[1]], mesh->positions[face[2]]});
  if (const auto* mesh = std::get_if<BilinearMeshShape>(&shape.geometry))
    for (const auto& face : mesh->patches)
      edges.add(std::array{mesh->positions[face[0]], mesh->positions[face[1]],
                           mesh->positions[face[3]], mesh->positions[face[2]]});
}

}  // namespace

double open_edges(const Shape& shape) {
  if (is_closed(shape)) return 0;
  Edges edges;
  add_faces(shape, edges);
  return edges.open();
}

bool is_watertight(const Shape& shape) {
  if (is_closed(shape) || std::holds_alternative<MolecularSurfaceShape>(shape.geometry))
    return true;
  EdgeParity edges;
  add_faces(shape, edges);
  return edges.is_even();
}

}  // namespace caplet
