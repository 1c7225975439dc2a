// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The spaces of a csg shape's operands. Programs for scenes at rest have no times.
#ifndef CAPLET_SHAPES_CSG_SPACE_CL
#define CAPLET_SHAPES_CSG_SPACE_CL

#include "math/floats.cl"
#include "math/motion.cl"
#include "math/vector.cl"

// CsgSpace is where a group's operands are: object_from_csg and csg_from_object, 12 floats each or,
// where it has segments of time, as a motion (math/motion.cl).
typedef struct {
  __global const float* matrices;
#ifdef CAPLET_MOTION
  uint segments;
  float time;
#endif
} CsgSpace;

// Returns the space of the group whose row is `group` (csg.cl) at a time.
static inline CsgSpace csg_space(Floats leaves, __global const uint* group, float time) {
  CsgSpace space;
  space.matrices = floats_at(leaves, group[4] != CAPLET_NONE ? group[4] : 0u);
#ifdef CAPLET_MOTION
  space.segments = group[6];
  space.time = time;
#else
  (void)time;
#endif
  return space;
}

static inline Affine object_from_csg(const CsgSpace* space) {
#ifdef CAPLET_MOTION
  if (space->segments != 0u)
    return motion_at(space->matrices, space->segments, 2u, 0u, space->time);
#endif
  return affine_load(space->matrices);
}

static inline Affine csg_from_object(const CsgSpace* space) {
#ifdef CAPLET_MOTION
  if (space->segments != 0u)
    return motion_at(space->matrices, space->segments, 2u, 1u, space->time);
#endif
  return affine_load(space->matrices + 12);
}

#endif
