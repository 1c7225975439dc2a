// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Capsules whose ends and radii change while the shutter is open.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "scene/shapes/ends.h"

namespace caplet {

/// Returns capsules with times as they are at one time (seconds): linear between two of their
/// times, and at rest before the first and after the last one.
CapsulesShape at_time(const CapsulesShape& capsules, double time);

/// CapsuleMotion is capsules with times as kernels read them (kernels/shapes/moving_ends.cl), at
/// times from 0, when the shutter opens, to 1, when it closes.
class CapsuleMotion {
 public:
  /// `open`, `open_time`: when the shutter opens, and for how long it is open (seconds).
  CapsuleMotion(const CapsulesShape& capsules, double open, double open_time);

  /// Returns whether no capsule changes while the shutter is open.
  bool rests() const;
  std::uint32_t segments() const { return static_cast<std::uint32_t>(pairs_.size() / 2); }
  /// Returns the begin of each segment of time, and one over its length.
  const std::vector<float>& pairs() const { return pairs_; }
  /// Returns p0 r0 p1 r1 of a capsule at the begin of a segment, or, for key number segments(), at
  /// the end of the last one.
  std::array<float, 8> key(std::size_t capsule, std::size_t key) const;
  /// Returns all capsules at a time in [0, 1], to the bit as kernels see them.
  CapsulesShape at(float time) const;

 private:
  const CapsulesShape& capsules_;
  std::vector<CapsulesShape> keys_;  // without materials and u
  std::vector<float> pairs_;
};

}  // namespace caplet
