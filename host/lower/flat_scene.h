// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// These are flat arrays and records, by the names of the groups' buffers, which lowering makes of a
// scene and of a view of it.
#pragma once

#include <cmath>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "shared/groups.h"
#include "shared/records.h"

namespace caplet {

// Members have the names and types of the groups' buffers.
#define GROUP_BEGIN(Type, group)
#define GROUP_END(Type)
#define BUFFER(name, type, access) access(type) name{};
#define ONE(type) std::span<const type>
#define IN(type) std::span<const type>

/// SceneArrays tells where each array of a scene lies; a record is an array of one.
struct SceneArrays {
  SCENE_GROUPS
};

#undef ONE
#undef IN
#define ONE(type) type
#define IN(type) std::vector<type>

/// FlatScene is everything that a device needs of a scene, whatever the view.
struct FlatScene {
  SCENE_GROUPS

  /// Arrays that lie in a file in place of the members, which are empty then (tree_file.h); null:
  /// none do. What the pointer holds keeps the file's memory.
  std::shared_ptr<const SceneArrays> in_file{};
  /// Returns where the arrays are, in the file or in the members.
  SceneArrays arrays() const;

  // Kernels are built for these (stage_options): the kinds of shapes there are (bit k: kind k),
  // operands of csg among them, and the bits of leaf references for them.
  std::uint64_t shapes = ~std::uint64_t{0};
  std::uint64_t material_kinds()
      const;  // likewise, of `materials`, `textures` and `lights` as they are
  std::uint64_t texture_kinds() const;
  std::uint64_t light_kinds() const;
  std::uint64_t medium_kinds() const;
  bool has_media() const;      // or surfaces that light passes
  bool moves() const;          // some instance or capsule moves while the shutter is open
  bool multiscatters() const;  // some material makes up for what one scattering loses
  int leaf_kind_bits = CAPLET_LEAF_KIND_BITS;
  bool sky_is_unseen = false;        // by camera rays: there is a backdrop
  bool has_moving_operands = false;  // of csg shapes
  bool has_chains = false;           // capsules with u at their ends, operands of csg among them

  // These are for `info` and statistics.
  std::uint64_t primitive_count = 0, bvh_nodes = 0;
  int bvh_depth = 0;
  double bvh_sah = 0;
  double build_seconds = 0;
  std::uint64_t device_bytes() const;
  std::uint64_t geometry_bytes()
      const;  // nodes, leaves, primitive_geometry, instances, mesh arrays
};

/// FlatView is what is rendered of a scene: its camera, film and sampler.
struct FlatView {
  VIEW_GROUPS
};

/// Returns whether a plane cuts what the view shows.
inline bool has_clip(const FlatView& view) { return std::isfinite(view.view.clip_offset); }

#undef GROUP_BEGIN
#undef GROUP_END
#undef BUFFER
#undef ONE
#undef IN

}  // namespace caplet
