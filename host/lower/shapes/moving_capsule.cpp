// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include <algorithm>
#include <bit>
#include <cmath>

#include "base/check.h"
#include "lower/detail/flat_shapes.h"
#include "lower/detail/shapes.h"

namespace caplet {

namespace {

/// Returns the capsule as it is when the shutter opens.
const float* at_start(const FlatPrimitive& p, const std::vector<float>& leaves) {
  return &leaves[moving_capsule_begin(p.data)];
}

}  // namespace

MovingCapsules::MovingCapsules(const CapsuleMotion& motion, std::vector<float>& leaves)
    : motion_(motion), leaves_(leaves) {
  if (motion.rests()) {
    resting_ = motion.at(0);
    return;
  }
  times_ = append_key_times(motion.times(), leaves);
}

FlatPrimitive MovingCapsules::primitive(std::size_t i) {
  if (resting_) return flat_capsule(*resting_, i, nullptr, 1);
  FlatPrimitive p = make_primitive(shape_moving_capsule);
  p.data[moving_capsule_at_begin] = std::bit_cast<float>(narrow<std::uint32_t>(leaves_.size()));
  p.data[moving_capsule_at_times] = std::bit_cast<float>(times_);
  p.data[moving_capsule_at_segments] = std::bit_cast<float>(motion_.times().segments());
  std::array<double, 3> low, high;
  low.fill(INFINITY);
  high.fill(-INFINITY);
  double largest = 0;
  for (std::size_t key = 0; key <= motion_.times().segments(); ++key) {
    const std::array<float, 8> ends = motion_.key(i, key);
    leaves_.insert(leaves_.end(), ends.begin(), ends.end());
    for (const float value : ends) largest = std::max(largest, std::abs(double{value}));
    for (const std::size_t end : {0U, 4U})
      for (std::size_t k = 0; k < 3; ++k) {
        low[k] = std::min(low[k], double{ends[end + k]} - double{ends[end + 3]});
        high[k] = std::max(high[k], double{ends[end + k]} + double{ends[end + 3]});
      }
  }
  // Between two keys everything is linear, and so are the sides of the box. A fused product rounds
  // a difference and a sum: less than 2^-20 of the largest number.
  for (std::size_t k = 0; k < 3; ++k) {
    p.kept_box()[k] = std::nextafter(static_cast<float>(low[k] - 0x1p-20 * largest), -INFINITY);
    p.kept_box()[3 + k] = std::nextafter(static_cast<float>(high[k] + 0x1p-20 * largest), INFINITY);
  }
  return p;
}

double moving_capsule_area(const FlatPrimitive& p, const std::vector<float>& leaves) {
  const float* ends = at_start(p, leaves);
  return two_balls_area(length3(ends, ends + 4), ends[3], ends[7]);
}

void moving_capsule_pieces(const FlatPrimitive& p, const std::vector<float>& leaves,
                           Pieces& pieces) {
  const float* ends = at_start(p, leaves);
  pieces.balls(ends, ends + 4, ends[3], ends[7], {0, 0, 0});
}

FlatPrimitive moving_capsule_grown(FlatPrimitive p, double b, std::vector<float>& leaves) {
  // Radii are linear between keys, so those of all times grow by b.
  const std::size_t begin = moving_capsule_begin(p.data),
                    floats = 8 * (moving_capsule_segments(p.data) + std::size_t{1});
  p.data[moving_capsule_at_begin] = std::bit_cast<float>(narrow<std::uint32_t>(leaves.size()));
  for (std::size_t i = 0; i < floats; ++i) leaves.push_back(leaves[begin + i]);
  for (std::size_t i = leaves.size() - floats + 3; i < leaves.size(); i += 4)
    move_by(leaves[i], 1, b);
  for (std::size_t k = 0; k < 3; ++k) {
    move_by(p.kept_box()[k], -1, b);
    move_by(p.kept_box()[3 + k], 1, b);
  }
  return p;
}

}  // namespace caplet
