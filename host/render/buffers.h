// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// These are the groups of shared/groups.h as buffers of a device: TreeBuffers, SurfacesBuffers, ...
// One struct of all buffers was tried: a signature then does not say what a kernel reads, and of 47
// buffers sort_prefix uses 2, extend 7 and shade 39.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "device/device.h"
#include "film/film.h"
#include "lower/changes.h"
#include "lower/flat_scene.h"
#include "shared/groups.h"
#include "shared/records.h"

namespace caplet {

#define GROUP_BEGIN(Type, group) struct Type##Buffers {
#define BUFFER(name, type, access) Buffer<type> name;
#undef PARTS
#define PARTS(name, type) std::array<Buffer<type>, 3> name##_parts;  // those after the first
#define GROUP_END(Type) \
  }                     \
  ;
ALL_GROUPS
#undef GROUP_BEGIN
#undef BUFFER
#undef GROUP_END
#undef PARTS
#define PARTS(name, type)

/// Bindings are the buffers that a kernel runs with, one pointer a group: `bindings.tree`,
/// `bindings.surfaces`, ... Groups that it does not take may be null.
struct Bindings {
#define GROUP_BEGIN(Type, group) const Type##Buffers* group = nullptr;
#define BUFFER(name, type, access)
#define GROUP_END(Type)
  ALL_GROUPS
#undef GROUP_BEGIN
#undef BUFFER
#undef GROUP_END
};

#define GROUP_BEGIN(Type, group) Type##Buffers group;
#define BUFFER(name, type, access)
#define GROUP_END(Type)

/// SceneBuffers are the groups of a scene.
struct SceneBuffers {
  SCENE_GROUPS

  /// Allocates and sends. `encoding`: what the nodes are for; automatic: the device's. Throws
  /// RunError, before anything is allocated, when it does not fit.
  SceneBuffers(const Device& device, const FlatScene& scene,
               Encoding encoding = Encoding::automatic);
  /// Does the same, and gives back the memory of the scene's nodes and leaves, which are empty
  /// then.
  SceneBuffers(const Device& device, FlatScene&& scene);
  /// Sends what has changed, and returns its bytes. Buffers that have grown are allocated again,
  /// with some room to grow.
  std::uint64_t update(const Device& device, const FlatScene& scene, const SceneChanges& changes);
  void bind(Bindings& bindings) const;
  /// Returns the elements by which parts of arrays begin one after the other, for which kernels
  /// are built; 0: each array is in one buffer.
  std::size_t part_distance() const { return part_distance_; }

 private:
  Encoding encoding_;
  std::size_t part_distance_ = 0;
};

/// SensorBuffers are the groups of a view.
struct SensorBuffers {
  VIEW_GROUPS

  SensorBuffers() = default;
  SensorBuffers(const Device& device, const FlatView& view);
  void bind(Bindings& bindings) const;
};

/// PathNeeds is the state of paths that only some scenes or films need.
struct PathNeeds {
  Layers layers;
  bool cones = false;  // of textured scenes
  bool sides = false;  // of scenes with a light tree
  bool media = false;  // of scenes with media
  bool times = false;  // of scenes in which something moves
};

/// PathBuffers are the groups of paths under way, with room for `paths` paths and for `sort_bins`
/// bins and their sums.
struct PathBuffers {
  PATH_GROUPS

  PathBuffers(const Device& device, std::size_t paths, std::size_t sort_bins,
              const PathNeeds& needs);
  /// Allocates again the buffers that are too short for so many paths with such needs.
  void provide(const Device& device, std::size_t paths, const PathNeeds& needs);
  void bind(Bindings& bindings) const;
  /// These are the bytes on the device of each path, in all buffers or in the largest one.
  static std::uint64_t bytes_per_path(const PathNeeds& needs);
  static std::uint64_t largest_bytes_per_path(const PathNeeds& needs);
};

#undef GROUP_BEGIN
#undef BUFFER
#undef GROUP_END

}  // namespace caplet
