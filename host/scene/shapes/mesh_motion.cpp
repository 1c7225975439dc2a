// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "scene/shapes/mesh_motion.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace caplet {

namespace {

glm::vec3 unit(const glm::vec3& v) {
  const double length = glm::length(glm::dvec3(v));
  return length > 0 ? glm::vec3(glm::dvec3(v) / length) : glm::vec3(0);
}

MeshMotion::Key at_key(const TriangleMeshShape& of, std::size_t key) {
  const std::size_t count = vertex_count(of);
  const auto part = [&](const std::vector<glm::vec3>& list) {
    const auto begin = list.begin() + static_cast<std::ptrdiff_t>(key * count);
    return std::vector<glm::vec3>(begin, begin + static_cast<std::ptrdiff_t>(count));
  };
  MeshMotion::Key out{part(of.positions), {}};
  if (of.normals.empty()) return out;
  out.normals = part(of.normals);
  for (glm::vec3& normal : out.normals) normal = unit(normal);
  return out;
}

/// Returns a + u (b - a) of all vertices and normals. `mix` does it for two floats.
template <class Mix>
MeshMotion::Key between(MeshMotion::Key a, const MeshMotion::Key& b, const Mix& mix) {
  const auto all = [&](std::vector<glm::vec3>& to, const std::vector<glm::vec3>& other) {
    for (std::size_t i = 0; i < to.size(); ++i)
      for (int k = 0; k < 3; ++k) to[i][k] = mix(to[i][k], other[i][k]);
  };
  all(a.positions, b.positions);
  all(a.normals, b.normals);
  return a;
}

/// Interpolates in double and rounds once.
MeshMotion::Key rounded_at(const TriangleMeshShape& of, const BetweenKeys& place) {
  if (place.share == 0) return at_key(of, place.before);
  return between(at_key(of, place.before), at_key(of, place.after), rounded_between(place.share));
}

TriangleMeshShape with_faces(MeshMotion::Key key, const TriangleMeshShape& of) {
  return {std::move(key.positions), of.triangles, std::move(key.normals), of.uvs};
}

}  // namespace

bool add_key(TriangleMeshShape& mesh, std::size_t keys, const TriangleMeshShape& next) {
  if (mesh.positions.size() != keys * next.positions.size() ||
      mesh.normals.size() != keys * next.normals.size() || mesh.triangles != next.triangles)
    return false;
  mesh.positions.insert(mesh.positions.end(), next.positions.begin(), next.positions.end());
  mesh.normals.insert(mesh.normals.end(), next.normals.begin(), next.normals.end());
  return true;
}

TriangleMeshShape at_time(const TriangleMeshShape& mesh, double time) {
  return with_faces(rounded_at(mesh, between_keys(mesh.times, time)), mesh);
}

MeshMotion::MeshMotion(const TriangleMeshShape& mesh, double open, double open_time)
    : mesh_(mesh), times_(mesh.times, open, open_time) {
  for (const BetweenKeys& key : times_.keys()) keys_.push_back(rounded_at(mesh, key));
}

bool MeshMotion::rests() const {
  return std::ranges::all_of(keys_, [&](const Key& key) {
    return key.positions == keys_[0].positions && key.normals == keys_[0].normals;
  });
}

TriangleMeshShape MeshMotion::at(float time) const {
  const ShutterKeys::Place place = times_.at(time);
  return with_faces(between(keys_[place.segment], keys_[place.segment + 1], fused_between(place.u)),
                    mesh_);
}

}  // namespace caplet
