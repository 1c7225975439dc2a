// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Computes the spans of linked capsules, which share their ends with their neighbours (shapes.h):
// to the bit those of the capsules and tapered capsules that they are.
#ifndef CAPLET_SHAPES_LINKED_CAPSULE_CL
#define CAPLET_SHAPES_LINKED_CAPSULE_CL

#include "shapes/capsule_lanes.cl"

static inline CapsuleLanes linked_capsules(__global const float* block, uint lane) {
  CapsuleLanes c;
  c.p0.x = real_load(block + CAPLET_LINK_X, lane);
  c.p0.y = real_load(block + CAPLET_LINK_Y, lane);
  c.p0.z = real_load(block + CAPLET_LINK_Z, lane);
  c.r0 = real_load(block + CAPLET_LINK_R, lane);
  c.p1.x = real_load(block + CAPLET_LINK_X + 1, lane);
  c.p1.y = real_load(block + CAPLET_LINK_Y + 1, lane);
  c.p1.z = real_load(block + CAPLET_LINK_Z + 1, lane);
  c.r1 = real_load(block + CAPLET_LINK_R + 1, lane);
  c.is_sphere = int_of(0);
  c.is_capsule = c.r0 == c.r1;
  c.is_tapered = c.r0 != c.r1;
  return c;
}

// Returns the lanes that hold a capsule.
static inline real_mask links_filled(__global const float* block, uint lane) {
  const int count = as_int(block[1]);
#if CAPLET_REAL_WIDTH == 8
  (void)lane;
  return (int8)(0, 1, 2, 3, 4, 5, 6, 7) < int_of(count);
#else
  return (int)lane < count;
#endif
}

static inline Span linked_capsule_span(const ShapeRay* ray, __global const float* block,
                                       uint lane) {
  const CapsuleLanes c = linked_capsules(block, lane);
  return capsule_lanes_span(ray, &c);
}

static inline real_mask linked_capsule_hit(const ShapeRay* ray, __global const float* block,
                                           uint lane, real* t, real_mask* side) {
  const CapsuleLanes c = linked_capsules(block, lane);
  return capsule_lanes_hit(ray, &c, t, side);
}

// Returns the lanes that linked_capsule_hit may return, and few others. A tapered capsule lies
// within the capsule of its larger radius, and its hits are within 16 eps (|o - p0| + L + r0 + r1)
// of it: together 82 eps D + 32 eps r by capsule_near's derivation, which allows 96 eps (D + r).
static inline real_mask linked_capsule_near(const NearRay* ray, __global const float* block,
                                            uint lane, float t_min, float t_max) {
  const CapsuleLanes c = linked_capsules(block, lane);
  return capsule_near_of(ray, c.p0, c.p1, real_max(c.r0, c.r1), t_min, t_max);
}

#endif
