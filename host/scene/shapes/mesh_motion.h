// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Meshes whose vertices move while the shutter is open.
#pragma once

#include <cstddef>
#include <vector>

#include "scene/shapes/meshes.h"
#include "scene/shapes/shutter_keys.h"

namespace caplet {

/// Returns a mesh with times as it is at one time (seconds): vertices and unit normals are linear
/// between two of its times, and at rest before the first and after the last one.
TriangleMeshShape at_time(const TriangleMeshShape& mesh, double time);

/// Appends where the same vertices, which have `keys` so far, are at one more time; `times` stay as
/// they are. Returns false and changes nothing where the faces, or whether there are normals,
/// differ.
bool add_key(TriangleMeshShape& mesh, std::size_t keys, const TriangleMeshShape& next);

/// MeshMotion is a mesh with times as kernels read it (kernels/shapes/moving_corners.cl), at times
/// from 0, when the shutter opens, to 1, when it closes.
class MeshMotion {
 public:
  /// `open`, `open_time`: when the shutter opens, and for how long it is open (seconds).
  MeshMotion(const TriangleMeshShape& mesh, double open, double open_time);

  /// Vertices and normals (empty or one a vertex, of length 1 or 0).
  struct Key {
    std::vector<glm::vec3> positions, normals;
  };

  /// Returns whether no vertex or normal changes while the shutter is open.
  bool rests() const;
  const ShutterKeys& times() const { return times_; }
  /// Returns the mesh at the begin of each segment of time, and at the end of the last one.
  const std::vector<Key>& keys() const { return keys_; }
  /// Returns the mesh at a time in [0, 1], its vertices to the bit as kernels see them.
  TriangleMeshShape at(float time) const;

 private:
  const TriangleMeshShape& mesh_;
  ShutterKeys times_;
  std::vector<Key> keys_;
};

}  // namespace caplet
