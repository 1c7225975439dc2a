// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Builds trees of what moves while the shutter is open: one for each of equal parts of that time,
// the intervals, because boxes of all that is swept overlap, and rays would come to most of them.
#pragma once

#include <functional>
#include <vector>

#include "lower/detail/encode.h"

namespace caplet {

/// MovingBoxes tells which primitives of a tree move, and where they are in an interval.
struct MovingBoxes {
  std::function<bool(const FlatPrimitive&)> moves;
  /// Sets the kept box to all that the primitive, which moves, sweeps from one time to another, in
  /// [0, 1] of the time that the shutter is open. It is called from several threads.
  std::function<void(FlatPrimitive&, float begin, float end)> set_box;
};

/// Does as encode_tree where nothing moves. Otherwise the times at which a ray may see the scene
/// are divided by a power of two, as long as each halving makes the sum of the boxes' areas smaller
/// by a fifth. What rests has a tree of its own, which all of these trees share, unless it is but
/// primitives, no more than those that move.
EncodedTree encode_trees(const TreeItems& items, const MovingBoxes& boxes, bool release,
                         std::vector<float>& nodes, std::vector<float>& leaves, int kind_bits);

}  // namespace caplet
