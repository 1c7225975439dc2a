// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This shape is part of a sphere around the origin, open: pbrt's sphere.
//
// Both crossings of the sphere (sphere.cl) are tested against the clips: the first goes in, the
// second out. The points tested are those that are reported, so a clip is off by their own error:
// 16 eps (|o| + r).
#ifndef CAPLET_SHAPES_PARTIAL_SPHERE_CL
#define CAPLET_SHAPES_PARTIAL_SPHERE_CL

#include "shapes/sphere.cl"
#include "shapes/turn.cl"

static inline real_mask partial_sphere_holds(const ShapeRay* ray, __global const float* block,
                                             uint lane, real t) {
  const real r = partial_sphere_r_lanes(block, lane), low = partial_sphere_z_min_lanes(block, lane),
             high = partial_sphere_z_max_lanes(block, lane);
  const real x = ray->ox + t * ray->dx, y = ray->oy + t * ray->dy, z = ray->oz + t * ray->dz;
  // A clip at the pole or beyond does not clip, because rounding may place z there.
  const real_mask above = (z >= low) | (low <= -r), below = (z <= high) | (high >= r);
  return above & below & within_turn(x, y, partial_sphere_phi_max_lanes(block, lane));
}

static inline Span partial_sphere_span(const ShapeRay* ray, __global const float* block,
                                       uint lane) {
  real t_enter, t_exit;
  const real_mask hit =
      sphere_span_within(ray, real_of(ray->ox), real_of(ray->oy), real_of(ray->oz),
                         partial_sphere_r_lanes(block, lane), real_of(0.0f), &t_enter, &t_exit);
  Span span = span_of(hit, t_enter, t_exit);
  if (mask_bits(hit) == 0) return span;
  span.enter = hit & partial_sphere_holds(ray, block, lane, t_enter);
  span.exit = hit & partial_sphere_holds(ray, block, lane, t_exit);
  return span;
}

SPAN_HIT(partial_sphere)

#endif
