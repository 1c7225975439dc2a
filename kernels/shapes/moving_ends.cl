// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Where the ends of a capsule that moves are at a time. Host code that does the same operations
// gets the same bits (CapsuleMotion, host/scene/shapes/capsule_motion.h).
#ifndef CAPLET_SHAPES_MOVING_ENDS_CL
#define CAPLET_SHAPES_MOVING_ENDS_CL

#include "math/floats.cl"
#include "math/motion.cl"

// Returns p0 r0 p1 r1 at a time in [0, 1]. The parameters are the fields of moving_capsule.
static inline float8 moving_ends(Floats leaves, uint begin, uint times, uint segments, float time) {
  float u;
  const uint segment = motion_segment(floats_at(leaves, times), segments, time, &u);
  const float8 from = vload8(segment, floats_at(leaves, begin)),
               to = vload8(segment + 1u, floats_at(leaves, begin));
  // At the end of a short last segment u may be beyond 1, where radii could be negative.
  return fma((float8)(fmin(u, 1.0f)), to - from, from);
}

#endif
