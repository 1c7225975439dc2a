// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Embree, 3 or 4, on the same primitives and rays: single rays, all cores.
#pragma once

#if CAPLET_EMBREE_MAJOR == 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <array>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "lower/encode.h"
#include "shared/kinds.h"
#include "shared/records.h"

namespace caplet::test {

struct PeerHit {
  std::uint32_t id = CAPLET_NONE;  // of the primitive; CAPLET_NONE: none
  float t = std::numeric_limits<float>::infinity();
};

/// Round linear curves: segment i runs from vertex first[i] (x y z radius) to the next one. Those that share a vertex are
/// neighbours where they follow each other.
struct RoundCurves {
  std::vector<std::array<float, 4>> vertices;
  std::vector<unsigned> first;
};

class Peer {
 public:
  /// Of one kind. Capsules become two-vertex round linear curves, spheres and disks Embree's points. `flags`: of the scene.
  /// Throws std::runtime_error.
  explicit Peer(std::span<const FlatPrimitive> primitives, RTCSceneFlags flags = RTC_SCENE_FLAG_NONE);
  explicit Peer(const RoundCurves& curves, RTCSceneFlags flags = RTC_SCENE_FLAG_NONE);
  ~Peer();
  Peer(const Peer&) = delete;
  Peer& operator=(const Peer&) = delete;

  /// Traces all rays; returns how many hit. `ids` (same length) receives the primitive hit, CAPLET_NONE: none.
  std::size_t trace(std::span<const RayRecord> rays, std::span<std::uint32_t> ids) const;
  std::vector<PeerHit> closest(std::span<const RayRecord> rays) const;
  double build_seconds() const { return build_seconds_; }

  /// "3.13.5", and which kinds of faces it was built to ignore.
  static std::string version();

 private:
  void build(RTCGeometry geometry, RTCSceneFlags flags);
  template <class Store>
  void trace_with(std::span<const RayRecord> rays, const Store& store) const;

  RTCScene scene_;
  double build_seconds_ = 0;
};

}  // namespace caplet::test
