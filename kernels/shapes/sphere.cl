// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Computes the sphere's span from the perpendicular of its centre on the ray (Haines et al.,
// "Precision improvements for ray/sphere intersection", Ray Tracing Gems 2019).
#ifndef CAPLET_SHAPES_SPHERE_CL
#define CAPLET_SHAPES_SPHERE_CL

#include "shapes/lanes.cl"

// Finds where the ray from w (relative to the centre) meets the sphere of radius r: lanes met, and
// both parameters. Error of the surface distance: w is rounded once (eps |w|), the shift t_c has
// relative error 5 eps and moves the point along the ray, the perpendicular q is off by 4 eps |w|,
// r^2 - q^2 by 4 eps r^2: 8 eps (|o - c| + r) together (docs/numerics.md). A ray that passes within
// `room` counts as touching.
static inline real_mask sphere_span_within(const ShapeRay* ray, real wx, real wy, real wz, real r,
                                           real room, real* t_enter, real* t_exit) {
  const real tc = -real_dot(wx, wy, wz, ray->dx, ray->dy, ray->dz) * ray->inv_dd;
  const real qx = wx + tc * ray->dx, qy = wy + tc * ray->dy, qz = wz + tc * ray->dz;
  // A second step removes the error of the first, which matters when the origin is far.
  const real tr = -real_dot(qx, qy, qz, ray->dx, ray->dy, ray->dz) * ray->inv_dd;
  const real qq = real_dot(qx, qy, qz, qx, qy, qz), disc = r * r - qq, outer = r + room;
  const real h = sqrt(real_max(disc, real_of(0.0f)) * ray->inv_dd);
  *t_enter = tc + (tr - h);
  *t_exit = tc + (tr + h);
  return qq <= outer * outer;
}

static inline Span sphere_span_of(const ShapeRay* ray, RealVector c, real r) {
  const real wx = ray->ox - c.x, wy = ray->oy - c.y, wz = ray->oz - c.z;
  real t_enter, t_exit;
  const real_mask hit = sphere_span_within(ray, wx, wy, wz, r, real_of(0.0f), &t_enter, &t_exit);
  return span_of(hit, t_enter, t_exit);
}

static inline Span sphere_span(const ShapeRay* ray, __global const float* block, uint lane) {
  return sphere_span_of(ray, sphere_c_lanes(block, lane), sphere_r_lanes(block, lane));
}

SPAN_HIT(sphere)

#endif
