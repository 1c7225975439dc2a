// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This shape is part of a disk across the z axis, open: pbrt's disk.
//
// The plane is crossed at (height - o_z) / d_z, with a relative error of 6 eps, and the point
// reported there is tested against the rims: it is off by 8 eps (|o - c| + r).
#ifndef CAPLET_SHAPES_PARTIAL_DISK_CL
#define CAPLET_SHAPES_PARTIAL_DISK_CL

#include "shapes/turn.cl"

static inline Span partial_disk_span(const ShapeRay* ray, __global const float* block, uint lane) {
  const real r = partial_disk_r_lanes(block, lane), inner = partial_disk_inner_lanes(block, lane);
  // Along the plane the quotient is infinite or NaN, and so are the point's coordinates: within no
  // rim.
  const real t = (partial_disk_height_lanes(block, lane) - ray->oz) / ray->dz;
  const real x = ray->ox + t * ray->dx, y = ray->oy + t * ray->dy;
  const real squared = x * x + y * y;
  const real_mask hit = (squared <= r * r) & (squared >= inner * inner) & (fabs(t) < INFINITY);
  const int leaving = ray->dz > 0.0f ? CAPLET_LEAVING : 0;
  return span_of_one(hit & within_turn(x, y, partial_disk_phi_max_lanes(block, lane)), t,
                     int_of(leaving));
}

SPAN_HIT(partial_disk)

#endif
