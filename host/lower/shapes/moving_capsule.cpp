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
  for (std::size_t key = 0; key <= motion_.times().segments(); ++key) {
    const std::array<float, 8> ends = motion_.key(i, key);
    leaves_.insert(leaves_.end(), ends.begin(), ends.end());
  }
  set_moving_capsule_box(p, leaves_, 0, 1);
  return p;
}

void set_moving_capsule_box(FlatPrimitive& p, const std::vector<float>& leaves, float begin,
                            float end) {
  SweptBox box;
  for (const KeyPlace& place : key_places(leaves, moving_capsule_times(p.data),
                                          moving_capsule_segments(p.data), begin, end)) {
    const float* from = &leaves[moving_capsule_begin(p.data) + std::size_t{8} * place.segment];
    for (const std::size_t at : {0U, 4U})
      box.add(from + at, from + 8 + at, place.u, from[at + 3], from[8 + at + 3]);
  }
  box.keep(p);
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
