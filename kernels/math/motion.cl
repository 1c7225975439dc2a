// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Where a thing that moves is at a time. Host code that does the same operations gets the same
// bits (host/lower/motion.h).
#ifndef CAPLET_MATH_MOTION_CL
#define CAPLET_MATH_MOTION_CL

#include "math/vector.cl"
#include "shared/limits.h"

// Returns row `row` of a matrix, 4 floats, whose entries are cubic polynomials of u: the four
// coefficients of the row one after the other.
static inline float4 motion_row(__global const float* cubics, size_t row, float u) {
  const float4 at = (float4)(u);
  return fma(fma(fma(vload4(4 * row + 3, cubics), at, vload4(4 * row + 2, cubics)), at,
                 vload4(4 * row + 1, cubics)),
             at, vload4(4 * row, cubics));
}

// Returns the segment of a motion that a time in [0, 1] falls into, and where in it as `u`.
// `pairs`: the begin of each segment, and one over its length.
static inline uint motion_segment(__global const float* pairs, uint segments, float time,
                                  float* u) {
  uint low = 0u, high = segments - 1u;
  while (low < high) {
    const uint middle = (low + high + 1u) / 2u;
    if (pairs[2u * middle] <= time)
      low = middle;
    else
      high = middle - 1u;
  }
  *u = (time - pairs[2u * low]) * pairs[2u * low + 1u];
  return low;
}

// Returns matrix number `matrix` of `matrices` of a motion at a time in [0, 1]. The motion begins
// with the pairs of its segments; then come the cubics of each segment's matrices.
static inline Affine motion_at(__global const float* motion, uint segments, uint matrices,
                               uint matrix, float time) {
  float u;
  const uint segment = motion_segment(motion, segments, time, &u);
  __global const float* cubics =
      motion + 2u * segments + (size_t)CAPLET_MOTION_FLOATS * (matrices * segment + matrix);
  Affine a;
  for (int row = 0; row < 3; row++) vstore4(motion_row(cubics, row, u), row, a.m);
  return a;
}

#endif
