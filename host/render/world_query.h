// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Looks at many worlds of one scene, by launches of many worlds each.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/mat4x4.hpp>
#include <span>
#include <vector>

#include "device/device.h"
#include "lower/worlds.h"
#include "render/device_scene.h"

namespace caplet {

using Vector3 = std::array<float, 3>;

/// Where WorldQuery writes: one element for each ray, worlds first, then cameras, then directions.
/// What is empty is left out. Numbers are CAPLET_NONE, and vectors 0, where a ray misses.
struct WorldHits {
  std::span<float> t;  // in lengths of the direction; INFINITY where the ray misses
  std::span<std::uint32_t> shape, instance, primitive;  // WorldsIdentity
  std::span<std::uint32_t> material_id;                 // as in PickRecord
  std::span<Vector3> normal, point;                     // as in PickRecord
  /// Returns hits [first, first + count).
  WorldHits part(std::size_t first, std::size_t count) const;
};

/// WorldQuery finds the nearest crossings in the worlds that `Worlds` places. Members throw
/// RunError.
class WorldQuery {
 public:
  /// Sends the shapes to the device. `batch_rays`: most rays of a launch; 0: chosen for the device.
  WorldQuery(Worlds worlds, const Device& device, std::size_t batch_rays = 0);

  /// Traces `directions` (in the camera's space, of any length) from each of `cameras`
  /// (world_from_camera, equally many for each world, one world after the other) through worlds
  /// with these transforms and ends (Worlds::place). Throws InputError as Worlds::place does.
  void look(std::size_t worlds, std::span<const glm::dmat4> transforms,
            std::span<const Capsule> ends, std::span<const glm::dmat4> cameras,
            std::span<const Vector3> directions, const WorldHits& out);

  /// These are the parts of that. Places worlds as Worlds::place does, and sends them.
  void place(std::size_t worlds, std::span<const glm::dmat4> transforms,
             std::span<const Capsule> ends = {}, std::size_t first_world = 0);
  /// Writes the nearest crossing of each ray, as many rays for each world that is placed, one world
  /// after the other. Without `points` their points, normals, uv and errors are 0.
  void closest(std::span<const RayRecord> rays, bool points, std::span<PickRecord> out);

  const Worlds& worlds() const { return worlds_; }

 private:
  void set_rays(std::span<const glm::dmat4> cameras, std::span<const Vector3> directions);
  void launch(std::span<const uint> roots, std::span<const RayRecord> rays, bool points,
              std::span<PickRecord> out);
  void keep(const WorldHits& out) const;

  Worlds worlds_;
  DeviceScene scene_;
  std::size_t batch_rays_;
  std::vector<RayRecord> rays_;
  std::vector<PickRecord> picks_;
  QueryBuffers query_buffers_;
  WorldsBuffers worlds_buffers_;
  PicksBuffers picks_buffers_;
};

}  // namespace caplet
