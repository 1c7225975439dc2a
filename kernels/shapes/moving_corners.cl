// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Where the corners of a triangle that moves are at a time. Host code that does the same operations
// gets the same bits (MeshMotion, host/scene/shapes/mesh_motion.h).
#ifndef CAPLET_SHAPES_MOVING_CORNERS_CL
#define CAPLET_SHAPES_MOVING_CORNERS_CL

#include "math/floats.cl"
#include "math/motion.cl"

// KeyPair is the begin and the end of the segment of time that a time falls into, and where
// between them it lies.
typedef struct {
  __global const float* from;
  __global const float* to;
  float u;
} KeyPair;

// The parameters are the fields of moving_triangle; the time is in [0, 1].
static inline KeyPair triangle_keys(Floats leaves, uint begin, uint times, uint segments,
                                    uint stride, float time) {
  KeyPair keys;
  const uint segment = motion_segment(floats_at(leaves, times), segments, time, &keys.u);
  // At the end of a short last segment u may be beyond 1.
  keys.u = fmin(keys.u, 1.0f);
  keys.from = floats_at(leaves, begin + (size_t)stride * segment);
  keys.to = floats_at(leaves, begin + (size_t)stride * (segment + 1u));
  return keys;
}

// Returns number i of the numbers of a key at the time.
static inline float between_keys(KeyPair keys, uint i) {
  return fma(keys.u, keys.to[i] - keys.from[i], keys.from[i]);
}
static inline float3 vector_between_keys(KeyPair keys, uint i) {
  return (float3)(between_keys(keys, i), between_keys(keys, i + 1u), between_keys(keys, i + 2u));
}

#endif
