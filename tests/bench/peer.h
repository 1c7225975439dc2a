// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Embree 3 on the same primitives and rays: single rays, all cores.
#pragma once

#include <embree3/rtcore.h>

#include <span>

#include "lower/encode.h"
#include "shared/records.h"

namespace caplet::bench {

class Peer {
 public:
  /// Of one kind. Capsules become two-vertex round linear curves, spheres and disks Embree's points.
  explicit Peer(std::span<const FlatPrimitive> primitives);
  ~Peer();
  Peer(const Peer&) = delete;
  Peer& operator=(const Peer&) = delete;

  /// Traces all rays; returns how many hit. `ids` (same length) receives the primitive hit, CAPLET_NONE: none.
  std::size_t trace(std::span<const RayRecord> rays, std::span<std::uint32_t> ids) const;
  double build_seconds() const { return build_seconds_; }

 private:
  RTCDevice device_;
  RTCScene scene_;
  double build_seconds_ = 0;
};

}  // namespace caplet::bench
