// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Queries a lowered scene for what rays hit.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "device/device.h"
#include "lower/flat_scene.h"
#include "render/device_scene.h"

namespace caplet {

struct QueryOptions {
  std::size_t batch_rays = 0;  // most rays of a launch; 0: chosen for the device
  std::size_t batch_hits =
      0;  // most crossings a launch of `all` has room for; 0: chosen for the device
};

/// A ray can have at most this many crossings in a query.
inline constexpr std::size_t max_query_capacity = std::size_t{1} << 20;

/// HitLists holds all crossings of many rays: those of ray i are crossings[begin[i]] to
/// crossings[begin[i + 1]], ordered by t.
struct HitLists {
  std::vector<PickRecord> crossings;
  std::vector<std::size_t> begin;       // one more than rays
  std::vector<std::size_t> overflowed;  // rays with more crossings than the capacity, whose lists
                                        // are therefore not complete
};

/// Times are in [0, 1], from the opening of the shutter to its closing, one for each ray; none: all
/// 0. Rays have t in (t_min, t_max) of their record and directions of any length; rays that are not
/// finite or have no direction miss. Kernels are compiled at the first query of their kind. The
/// memory of a query on the device does not grow with the number of rays. Throws RunError.
class Query {
 public:
  /// Queries `scene`, which must outlive this.
  explicit Query(DeviceScene& scene, const QueryOptions& options = {});
  /// Sends the scene to the device for this query alone.
  Query(const FlatScene& scene, const Device& device, const QueryOptions& options = {});

  /// Returns the nearest crossing of each ray; t is INFINITY where it misses.
  std::vector<PickRecord> closest(std::span<const RayRecord> rays,
                                  std::span<const float> times = {});
  /// Returns every crossing of each ray, the nearest `capacity` (1 to max_query_capacity) where
  /// there are more.
  HitLists all(std::span<const RayRecord> rays, std::size_t capacity,
               std::span<const float> times = {});

  double compile_seconds() const { return scene_->kernels().compile_seconds(); }

 private:
  Query(std::shared_ptr<DeviceScene> scene, const QueryOptions& options);
  /// Makes room; buffers that are too small lose their contents.
  void reserve(std::size_t rays, std::size_t hits, std::size_t picks);
  Bindings bindings() const;
  /// Sends rays, and their times where something moves.
  void send(std::span<const RayRecord> rays, std::span<const float> times);

  std::shared_ptr<DeviceScene> scene_;  // its own, or another's that it does not delete
  std::size_t batch_rays_, batch_hits_;
  QueryBuffers query_;
  CrossingsBuffers crossings_;
  PicksBuffers picks_;
};

}  // namespace caplet
