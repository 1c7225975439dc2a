// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Questions to a lowered scene: what do these rays hit?
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "device/device.h"
#include "lower/lower.h"
#include "render/stages.h"

namespace caplet {

struct QueryOptions {
  std::size_t batch_rays = 0;  // most rays of a launch; 0: chosen for the device
  std::size_t batch_hits = 0;  // most crossings a launch of `all` has room for; 0: chosen for the device
};

/// Most crossings a ray can be asked for.
inline constexpr std::size_t max_query_capacity = std::size_t{1} << 20;

/// All crossings of many rays: those of ray i are crossings[begin[i]] to crossings[begin[i + 1]], ordered by t.
struct HitLists {
  std::vector<PickRecord> crossings;
  std::vector<std::size_t> begin;       // one more than rays
  std::vector<std::size_t> overflowed;  // rays with more crossings than the capacity, whose lists are therefore not complete
};

/// Holds the scene on the device. Rays have t in (t_min, t_max) of their record and directions of any length; rays that are not
/// finite or have no direction miss. Kernels are compiled at the first question of their kind. What a query needs on the device
/// does not grow with the number of rays. Throws RunError.
class Query {
 public:
  Query(const FlatScene& scene, const Device& device, const QueryOptions& options = {});

  /// The nearest crossing of each ray; t is INFINITY where it misses.
  std::vector<PickRecord> closest(std::span<const RayRecord> rays);
  /// Every crossing of each ray, the nearest `capacity` (1 to max_query_capacity) where there are more.
  HitLists all(std::span<const RayRecord> rays, std::size_t capacity);

  double compile_seconds() const { return stages_.compile_seconds(); }

 private:
  ParamsRecord params_;
  std::size_t batch_rays_, batch_hits_;
  Stages stages_;
};

}  // namespace caplet
