// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This shape is an open tube around the z axis, or part of one: pbrt's cylinder.
//
// Across the axis the ray is e + t f, with e and f as given: nothing is rounded. As for spheres,
// the perpendicular from the axis and half the chord place the crossings within 8 eps (|e| + r) of
// the tube, however flat the ray. Both are tried against the clips at the parameters that are
// reported, which adds 3 eps (|o - c| + size) (docs/numerics.md, "Partial shapes").
#ifndef CAPLET_SHAPES_OPEN_CYLINDER_CL
#define CAPLET_SHAPES_OPEN_CYLINDER_CL

#include "shapes/turn.cl"

static inline real_mask open_cylinder_holds(const ShapeRay* ray, __global const float* block,
                                            uint lane, real t) {
  const real x = ray->ox + t * ray->dx, y = ray->oy + t * ray->dy, rise = t * ray->dz;
  const real_mask above = rise + (ray->oz - open_cylinder_z_min_lanes(block, lane)) >= 0.0f;
  const real_mask below = rise + (ray->oz - open_cylinder_z_max_lanes(block, lane)) <= 0.0f;
  return above & below & within_turn(x, y, open_cylinder_phi_max_lanes(block, lane));
}

static inline Span open_cylinder_span(const ShapeRay* ray, __global const float* block, uint lane) {
  const real r = open_cylinder_r_lanes(block, lane);
  const float ff = ray->dx * ray->dx + ray->dy * ray->dy;
  // A ray within 2^-40 of the axis' direction crosses no tube that single precision can hold.
  const int crosses = ff * ray->inv_dd > 0x1p-80f && ff > 0x1p-120f;
  const float inv_ff = 1.0f / (crosses ? ff : 1.0f);
  const float t0 = -(ray->ox * ray->dx + ray->oy * ray->dy) * inv_ff;
  const float ax = ray->ox + t0 * ray->dx, ay = ray->oy + t0 * ray->dy;
  // A second step removes the error of the first, which matters when the origin is far.
  const float t1 = -(ax * ray->dx + ay * ray->dy) * inv_ff;
  const float qx = ax + t1 * ray->dx, qy = ay + t1 * ray->dy;
  const real disc = r * r - (qx * qx + qy * qy);
  const real h = sqrt(real_max(disc, real_of(0.0f)) * inv_ff);
  const real_mask hit = (disc >= 0.0f) & int_of(-crosses);
  Span span = span_of(hit, t0 + (t1 - h), t0 + (t1 + h));
  if (mask_bits(hit) == 0) return span;
  span.enter = hit & open_cylinder_holds(ray, block, lane, span.t_enter);
  span.exit = hit & open_cylinder_holds(ray, block, lane, span.t_exit);
  return span;
}

SPAN_HIT(open_cylinder)

#endif
