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
#include "scene/shapes/shutter_keys.h"

namespace caplet {

/// Returns capsules with times as they are at one time (seconds): linear between two of their
/// times, and at rest before the first and after the last one.
CapsulesShape at_time(const CapsulesShape& capsules, double time);

/// Appends where the same capsules, which have `keys` so far, are at one more time; `times` stay as
/// they are. Returns false and changes nothing where they are not as many.
bool add_key(CapsulesShape& capsules, std::size_t keys, CapsulesShape next);

/// CapsuleMotion is capsules with times as kernels read them (kernels/shapes/moving_ends.cl), at
/// times from 0, when the shutter opens, to 1, when it closes.
class CapsuleMotion {
 public:
  /// `open`, `open_time`: when the shutter opens, and for how long it is open (seconds).
  CapsuleMotion(const CapsulesShape& capsules, double open, double open_time);

  /// Returns whether no capsule changes while the shutter is open.
  bool rests() const;
  const ShutterKeys& times() const { return times_; }
  /// Returns p0 r0 p1 r1 of a capsule at the begin of a segment, or, for key number
  /// times().segments(), at the end of the last one.
  std::array<float, 8> key(std::size_t capsule, std::size_t key) const;
  /// Returns all capsules at a time in [0, 1], to the bit as kernels see them.
  CapsulesShape at(float time) const;

 private:
  const CapsulesShape& capsules_;
  ShutterKeys times_;
  std::vector<CapsulesShape> keys_;  // without materials and u
};

}  // namespace caplet
