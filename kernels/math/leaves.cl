// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The array `leaves`, which lies in one buffer, or in parts where the device allows no buffer of
// its size (host/render/leaf_parts.h). Only the latter programs are built with CAPLET_LEAF_PART,
// the floats by which parts begin one after the other. Each goes on beyond the next one's begin, so
// that what begins in a part can be read from it.
#ifndef CAPLET_MATH_LEAVES_CL
#define CAPLET_MATH_LEAVES_CL

#ifdef CAPLET_LEAF_PART
typedef struct {
  __global const float* part0;
  __global const float* part1;
  __global const float* part2;
  __global const float* part3;
} Leaves;

// Returns where float `place` lies.
static inline __global const float* leaf_at(Leaves leaves, size_t place) {
  const size_t part = place / CAPLET_LEAF_PART;
  __global const float* const begin = part == 0   ? leaves.part0
                                      : part == 1 ? leaves.part1
                                      : part == 2 ? leaves.part2
                                                  : leaves.part3;
  return begin + (place - part * CAPLET_LEAF_PART);
}
#else
typedef __global const float* Leaves;

static inline __global const float* leaf_at(Leaves leaves, size_t place) { return leaves + place; }
#endif

#endif
