// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The groups of shared/groups.h as buffers of a device: TreeBuffers, SurfacesBuffers, ...
#pragma once

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
#define GROUP_END(Type) \
  }                     \
  ;
ALL_GROUPS
#undef GROUP_BEGIN
#undef BUFFER
#undef GROUP_END

/// The buffers that a kernel is run with, one pointer a group: `bindings.tree`, `bindings.surfaces`, ... Groups that it does not
/// take may be null.
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

/// The groups of a scene.
struct SceneBuffers {
  SCENE_GROUPS

  /// `encoding`: what the nodes are for; automatic: the device's. Throws RunError, before anything is allocated, when it does not
  /// fit.
  SceneBuffers(const Device& device, const FlatScene& scene, Encoding encoding = Encoding::automatic);
  /// Sends what has changed, and returns its bytes. Buffers that have grown are made anew, with some room to grow on.
  std::uint64_t update(const Device& device, const FlatScene& scene, const SceneChanges& changes);
  void bind(Bindings& bindings) const;

 private:
  Encoding encoding_;
};

/// The groups of a view.
struct SensorBuffers {
  VIEW_GROUPS

  SensorBuffers() = default;
  SensorBuffers(const Device& device, const FlatView& view);
  void bind(Bindings& bindings) const;
};

/// What paths carry beside what all do.
struct PathNeeds {
  Layers layers;
  bool cones = false;  // of textured scenes
  bool sides = false;  // of scenes with a light tree
  bool media = false;  // of scenes with media
};

/// Those of paths under way, which have `paths` places and `sort_bins` bins and sums of them.
struct PathBuffers {
  PATH_GROUPS

  PathBuffers(const Device& device, std::size_t paths, std::size_t sort_bins, const PathNeeds& needs);
  /// Makes those anew that are too short for so many paths with such needs.
  void provide(const Device& device, std::size_t paths, const PathNeeds& needs);
  void bind(Bindings& bindings) const;
  /// Bytes on the device of each path, in all buffers or in the largest one.
  static std::uint64_t bytes_per_path(const PathNeeds& needs);
  static std::uint64_t largest_bytes_per_path(const PathNeeds& needs);
};

#undef GROUP_BEGIN
#undef BUFFER
#undef GROUP_END

}  // namespace caplet
