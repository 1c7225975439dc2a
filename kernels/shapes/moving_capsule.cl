// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Computes the span of a capsule whose ends and radii change with time. At the ray's time it is a
// sphere, a capsule or a tapered capsule, and its span is the span of that shape to the bit.
#ifndef CAPLET_SHAPES_MOVING_CAPSULE_CL
#define CAPLET_SHAPES_MOVING_CAPSULE_CL

#include "shapes/capsule_lanes.cl"
#include "shapes/moving_ends.cl"

// Returns the capsules of some lanes at the ray's time.
static inline CapsuleLanes moving_capsules(const ShapeRay* ray, __global const float* block,
                                           uint lane) {
  CapsuleLanes c;
#if CAPLET_REAL_WIDTH == 8
  (void)lane;
  float data[8][8];
  for (uint i = 0; i < 8u; i++) {
    __global const float* of = lane_data(block, i);
    const float8 ends = moving_ends(ray->leaves, moving_capsule_begin(of), moving_capsule_times(of),
                                    moving_capsule_segments(of), ray_time(ray));
    float own[8];
    vstore8(ends, 0, own);
    for (uint k = 0; k < 8u; k++) data[k][i] = own[k];
  }
  c.p0.x = vload8(0, data[0]);
  c.p0.y = vload8(0, data[1]);
  c.p0.z = vload8(0, data[2]);
  c.r0 = vload8(0, data[3]);
  c.p1.x = vload8(0, data[4]);
  c.p1.y = vload8(0, data[5]);
  c.p1.z = vload8(0, data[6]);
  c.r1 = vload8(0, data[7]);
#else
  __global const float* of = lane_data(block, lane);
  const float8 ends = moving_ends(ray->leaves, moving_capsule_begin(of), moving_capsule_times(of),
                                  moving_capsule_segments(of), ray_time(ray));
  c.p0.x = ends.s0;
  c.p0.y = ends.s1;
  c.p0.z = ends.s2;
  c.r0 = ends.s3;
  c.p1.x = ends.s4;
  c.p1.y = ends.s5;
  c.p1.z = ends.s6;
  c.r1 = ends.s7;
#endif
  c.is_sphere = (c.p0.x == c.p1.x) & (c.p0.y == c.p1.y) & (c.p0.z == c.p1.z);
  const real_mask is_long = c.is_sphere == 0;
  c.is_capsule = is_long & (c.r0 == c.r1);
  c.is_tapered = is_long & (c.r0 != c.r1);
  return c;
}

static inline Span moving_capsule_span(const ShapeRay* ray, __global const float* block,
                                       uint lane) {
  const CapsuleLanes c = moving_capsules(ray, block, lane);
  return capsule_lanes_span(ray, &c);
}

static inline real_mask moving_capsule_hit(const ShapeRay* ray, __global const float* block,
                                           uint lane, real* t, real_mask* side) {
  const CapsuleLanes c = moving_capsules(ray, block, lane);
  return capsule_lanes_hit(ray, &c, t, side);
}

#endif
