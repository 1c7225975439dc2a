// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This shape is a flat disk, open and two-sided.
#ifndef CAPLET_SHAPES_DISK_CL
#define CAPLET_SHAPES_DISK_CL

#include "shapes/lanes.cl"

// The ray is moved to its point nearest to the centre first, so the plane distance is rounded
// relative to the disk's size and the origin's distance alone: 8 eps (|o - c| + r), along the
// normal.
static inline real_mask disk_hit(const ShapeRay* ray, __global const float* block, uint lane,
                                 real* t, real_mask* side) {
  const RealVector c = disk_c_lanes(block, lane), n = disk_n_lanes(block, lane);
  const real wx = ray->ox - c.x, wy = ray->oy - c.y, wz = ray->oz - c.z;
  const real r = disk_r_lanes(block, lane);
  const real shift = -real_dot(wx, wy, wz, ray->dx, ray->dy, ray->dz) * ray->inv_dd;
  const real px = wx + shift * ray->dx, py = wy + shift * ray->dy, pz = wz + shift * ray->dz;
  // Along the plane the quotient is infinite or NaN and lies in no interval.
  const real along = real_dot(n.x, n.y, n.z, ray->dx, ray->dy, ray->dz);
  const real s = -real_dot(px, py, pz, n.x, n.y, n.z) / along;
  const real qx = px + s * ray->dx, qy = py + s * ray->dy, qz = pz + s * ray->dz;
  *t = shift + s;
  *side = along > 0.0f ? int_of(CAPLET_LEAVING) : int_of(0);
  return real_dot(qx, qy, qz, qx, qy, qz) <= r * r;
}

static inline Span disk_span(const ShapeRay* ray, __global const float* block, uint lane) {
  real t;
  real_mask side;
  const real_mask hit = disk_hit(ray, block, lane, &t, &side);
  return span_of_one(hit, t, side);
}

#endif
