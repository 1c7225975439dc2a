// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Computes the span of a capsule whose ends and radii change with time. At the ray's time it is a
// sphere, a capsule or a tapered capsule, and its span is the span of that shape to the bit.
#ifndef CAPLET_SHAPES_MOVING_CAPSULE_CL
#define CAPLET_SHAPES_MOVING_CAPSULE_CL

#include "shapes/capsule.cl"
#include "shapes/moving_ends.cl"
#include "shapes/sphere.cl"
#include "shapes/tapered_capsule.cl"

// MovingCapsules are the capsules of some lanes at the ray's time. The masks say which of them are
// spheres, capsules and tapered capsules (flat_capsule, host/lower/shapes/capsule.cpp).
typedef struct {
  RealVector p0, p1;
  real r0, r1;
  real_mask is_sphere, is_capsule, is_tapered;
} MovingCapsules;

static inline MovingCapsules moving_capsules(const ShapeRay* ray, __global const float* block,
                                             uint lane) {
  MovingCapsules c;
#if CAPLET_REAL_WIDTH == 8
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
  const MovingCapsules c = moving_capsules(ray, block, lane);
  Span out = span_of(int_of(0), real_of(0.0f), real_of(0.0f));
  if (mask_bits(c.is_capsule) != 0) out = capsule_span_of(ray, c.p0, c.p1, c.r0);
  if (mask_bits(c.is_tapered) != 0) {
    const Span own = tapered_capsule_span_of(ray, c.p0, c.p1, c.r0, c.r1);
    out.t_enter = c.is_tapered ? own.t_enter : out.t_enter;
    out.t_exit = c.is_tapered ? own.t_exit : out.t_exit;
    out.enter = c.is_tapered ? own.enter : out.enter;
    out.exit = c.is_tapered ? own.exit : out.exit;
  }
  if (mask_bits(c.is_sphere) != 0) {
    const Span own = sphere_span_of(ray, c.p0, real_max(c.r0, c.r1));
    out.t_enter = c.is_sphere ? own.t_enter : out.t_enter;
    out.t_exit = c.is_sphere ? own.t_exit : out.t_exit;
    out.enter = c.is_sphere ? own.enter : out.enter;
    out.exit = c.is_sphere ? own.exit : out.exit;
  }
  return out;
}

static inline real_mask moving_capsule_hit(const ShapeRay* ray, __global const float* block,
                                           uint lane, real* t, real_mask* side) {
  const MovingCapsules c = moving_capsules(ray, block, lane);
  real_mask hit = int_of(0), own_side;
  real own_t;
  *t = real_of(0.0f);
  *side = int_of(0);
  if (mask_bits(c.is_capsule) != 0)
    hit = capsule_hit_of(ray, c.p0, c.p1, c.r0, t, side) & c.is_capsule;
  if (mask_bits(c.is_tapered) != 0) {
    const Span span = tapered_capsule_span_of(ray, c.p0, c.p1, c.r0, c.r1);
    hit |= span_nearest(ray, &span, &own_t, &own_side) & c.is_tapered;
    *t = c.is_tapered ? own_t : *t;
    *side = c.is_tapered ? own_side : *side;
  }
  if (mask_bits(c.is_sphere) != 0) {
    const Span span = sphere_span_of(ray, c.p0, real_max(c.r0, c.r1));
    hit |= span_nearest(ray, &span, &own_t, &own_side) & c.is_sphere;
    *t = c.is_sphere ? own_t : *t;
    *side = c.is_sphere ? own_side : *side;
  }
  return hit;
}

#endif
