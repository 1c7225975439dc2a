// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Many worlds at once: poses of one scene, as cameras see them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "caplet/device.h"
#include "caplet/scene.h"
#include "caplet/shape.h"

CAPLET_BEGIN

/// Where Batch writes: one element for each ray, worlds first, then cameras, then directions. What
/// is empty is left out. Numbers are Crossing::none where a ray misses.
struct BatchHits {
  std::span<float> t;  // in lengths of the direction; infinite where the ray misses
  std::span<std::uint32_t> shape, instance, primitive, material_id;  // as in Crossing
  std::span<std::array<float, 3>> normal, point;  // as in Crossing; 0 where the ray misses
};

/// Holds the shapes of a scene on a device, once for all worlds. Only one thread at a time may use
/// it. Members throw RunError.
class CAPLET_API Batch {
 public:
  /// `moving` has the numbers of shapes of the world (not of objects), each once, which are
  /// elsewhere in each world. `deforming` has the numbers of shapes of capsules of the world, each
  /// once, whose ends and radii are other ones in each world; they may move as well. Throws
  /// InputError for other numbers, for a deforming shape without capsules or that shows one side
  /// alone, for a scene that moves while its shutter is open, and when it exceeds a limit.
  Batch(const Scene& scene, std::span<const std::uint32_t> moving, const Device& device,
        std::span<const std::uint32_t> deforming = {});
  Batch(Batch&&) noexcept;
  Batch& operator=(Batch&&) noexcept;
  ~Batch();

  /// Traces rays through many worlds. `transforms`: world_from_object of each moving shape, in
  /// their order, for one world after the other. `cameras`: world_from_camera, equally many for
  /// each world, one world after the other. `directions`: rays of every camera, in its space, of
  /// any length. `ends`: the capsules of the deforming shapes, one shape after the other, for one
  /// world after the other. Throws InputError when numbers do not go together, for a transform that
  /// is not finite or has no inverse (a deforming shape's must have one scale in all directions),
  /// and for a capsule that is not finite or has a negative radius.
  void nearest(std::size_t worlds, std::span<const Transform> transforms,
               std::span<const Transform> cameras, std::span<const std::array<float, 3>> directions,
               const BatchHits& out, std::span<const Capsule> ends = {});

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

CAPLET_END
