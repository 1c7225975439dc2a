// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// A flat disk, open and two-sided. Rows of a block: c n(unit) r.
#ifndef CAPLET_SHAPES_DISK_CL
#define CAPLET_SHAPES_DISK_CL

#include "shapes/real.cl"

// The ray is moved to its point nearest to the centre first, so the plane distance is rounded relative to the disk's size and
// the origin's distance alone: 8 eps (|o - c| + r), along the normal.
static inline real_mask disk_hit(const ShapeRay* ray, __global const float* block, uint lane, real* t, real_mask* side) {
  const real wx = ray->ox - real_load(block + 8, lane), wy = ray->oy - real_load(block + 16, lane),
             wz = ray->oz - real_load(block + 24, lane);
  const real nx = real_load(block + 32, lane), ny = real_load(block + 40, lane), nz = real_load(block + 48, lane);
  const real r = real_load(block + 56, lane);
  const real shift = -real_dot(wx, wy, wz, ray->dx, ray->dy, ray->dz) * ray->inv_dd;
  const real px = wx + shift * ray->dx, py = wy + shift * ray->dy, pz = wz + shift * ray->dz;
  // Along the plane the quotient is infinite or NaN and lies in no interval.
  const real along = real_dot(nx, ny, nz, ray->dx, ray->dy, ray->dz);
  const real s = -real_dot(px, py, pz, nx, ny, nz) / along;
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
