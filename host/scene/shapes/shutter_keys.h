// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// When a shape whose numbers change with time is as one of its keys says.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "scene/shapes/family.h"

namespace caplet {

/// Reports times of keys that do not rise, and numbers of points that are not as many at each.
/// Returns whether all is right.
bool check_key_times(const std::vector<double>& times, std::size_t points, ShapeCheck& report);

/// BetweenKeys is a time between two keys of a shape: `share` of the way, from 0 to 1.
struct BetweenKeys {
  std::size_t before, after;
  double share;
};

/// Returns where a time (seconds) lies between keys, whose times rise. Before the first key and
/// after the last one both keys are that one.
BetweenKeys between_keys(const std::vector<double>& times, double time);

/// Returns a function of two floats: what is a share u of the way from one to the other, rounded
/// once.
inline auto rounded_between(double u) {
  return
      [u](float a, float b) { return static_cast<float>(double{a} + u * (double{b} - double{a})); };
}
/// Returns the same as kernels do it, to the bit (kernels/shapes/moving_ends.cl,
/// moving_corners.cl).
inline auto fused_between(float u) {
  return [u](float a, float b) { return std::fma(u, b - a, a); };
}

/// ShutterKeys are the keys of a shape while the shutter is open, at times from 0, when it opens,
/// to 1, when it closes. Kernels read them so (motion_segment, kernels/math/motion.cl).
class ShutterKeys {
 public:
  /// `times`: of the shape's keys (seconds). `open`, `open_time`: when the shutter opens, and for
  /// how long it is open (seconds).
  ShutterKeys(const std::vector<double>& times, double open, double open_time);

  /// Returns the number of segments of time; keys are one more.
  std::uint32_t segments() const { return static_cast<std::uint32_t>(pairs_.size() / 2); }
  /// Returns the begin of each segment of time, and one over its length.
  const std::vector<float>& pairs() const { return pairs_; }
  /// Returns what the shape is at the begin of each segment, and at the end of the last one.
  const std::vector<BetweenKeys>& keys() const { return keys_; }

  struct Place {
    std::size_t segment;
    float u;  // from 0 to 1
  };
  /// Returns where a time in [0, 1] lies, to the bit as kernels find it.
  Place at(float time) const;

 private:
  std::vector<BetweenKeys> keys_;
  std::vector<float> pairs_;
};

}  // namespace caplet
