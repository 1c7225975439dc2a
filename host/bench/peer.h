// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Traces the same primitives and rays with Embree, 3 or 4: single rays, all cores. Only peer.cpp
// uses Embree.
#pragma once

#include <array>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "lower/encode.h"
#include "shared/kinds.h"
#include "shared/records.h"

namespace caplet::bench {

struct PeerHit {
  std::uint32_t id = CAPLET_NONE;  // the primitive's id; CAPLET_NONE: none
  float t = std::numeric_limits<float>::infinity();
};

/// Round linear curves: segment i runs from vertex first[i] (x y z radius) to the next one.
/// Consecutive segments that share a vertex are neighbours.
struct RoundCurves {
  std::vector<std::array<float, 4>> vertices;
  std::vector<unsigned> first;
};

/// Selects Embree's scene flags: none, or RTC_SCENE_FLAG_ROBUST.
enum class PeerMode { fast, robust };

class Peer {
 public:
  /// Returns false if this is built without Embree; all else then throws std::runtime_error.
  static bool is_there();
  /// Takes primitives of one kind. Capsules become two-vertex round linear curves, spheres and
  /// disks Embree's points. Throws std::runtime_error.
  explicit Peer(std::span<const FlatPrimitive> primitives, PeerMode mode = PeerMode::fast);
  explicit Peer(const RoundCurves& curves, PeerMode mode = PeerMode::fast);
  ~Peer();
  Peer(const Peer&) = delete;
  Peer& operator=(const Peer&) = delete;

  /// Traces all rays and returns how many hit. `ids` (same length) receives the primitive that each
  /// ray hits, or CAPLET_NONE.
  std::size_t trace(std::span<const RayRecord> rays, std::span<std::uint32_t> ids) const;
  /// Tests whether each ray hits anything (rtcOccluded1), 1 or 0; returns how many do.
  std::size_t trace_any(std::span<const RayRecord> rays, std::span<std::uint32_t> found) const;
  std::vector<PeerHit> closest(std::span<const RayRecord> rays) const;
  double build_seconds() const { return build_seconds_; }

  /// Returns "3.13.5", and the kinds of faces that this build ignores.
  static std::string version();

 private:
  struct Scene;
  std::unique_ptr<Scene> scene_;
  double build_seconds_ = 0;
};

}  // namespace caplet::bench
