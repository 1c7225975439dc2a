// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// A box lies along the axes. Its span is the intersection of the spans of its three slabs.
//
// A plane is crossed at (plane - o) / d: the difference is rounded once and the product by 1 / d
// leaves a relative error of 7 eps, so the reported point is within 8 eps (|o - c| + size) of its
// plane (docs/numerics.md, "Boxes"). The crossing depends on nothing but the plane and the ray:
// boxes that share a coordinate are left and entered at the same t, and no ray slips between them.
#ifndef CAPLET_SHAPES_BOX_CL
#define CAPLET_SHAPES_BOX_CL

#include "shapes/lanes.cl"

// Computes the part of the ray between the planes at `low` and `high`, both included. `inv`: 1 / d,
// or 0 for a ray along the planes.
static inline void box_slab(real low, real high, float o, float inv, real* near, real* far) {
  if (inv == 0.0f) {
    const real_mask between = (low <= o) & (high >= o);
    const real never = real_of(INFINITY);
    *near = between ? -never : never;
    *far = between ? never : -never;
    return;
  }
  const real a = (low - o) * inv, b = (high - o) * inv;
  *near = inv > 0.0f ? a : b;
  *far = inv > 0.0f ? b : a;
}

// Returns 1 / d. A component below 2^-50 of the largest counts as zero: along the box it moves the
// ray by less than its size's rounding.
static inline float box_inverse(float d, float largest) {
  return fabs(d) < 0x1p-50f * largest ? 0.0f : 1.0f / d;
}

static inline Span box_span(const ShapeRay* ray, __global const float* block, uint lane) {
  const float largest = fmax(fmax(fabs(ray->dx), fabs(ray->dy)), fabs(ray->dz));
  const float ix = box_inverse(ray->dx, largest), iy = box_inverse(ray->dy, largest),
              iz = box_inverse(ray->dz, largest);
  real near_x, near_y, near_z, far_x, far_y, far_z;
  const RealVector low = box_low_lanes(block, lane), high = box_high_lanes(block, lane);
  box_slab(low.x, high.x, ray->ox, ix, &near_x, &far_x);
  box_slab(low.y, high.y, ray->oy, iy, &near_y, &far_y);
  box_slab(low.z, high.z, ray->oz, iz, &near_z, &far_z);
  const real_mask y_later = near_y > near_x, y_sooner = far_y < far_x;
  const real enter = y_later ? near_y : near_x, exit = y_sooner ? far_y : far_x;
  const real_mask z_later = near_z > enter, z_sooner = far_z < exit;
  const real_mask enter_xy = y_later ? int_of(iy > 0.0f ? 2 : 3) : int_of(ix > 0.0f ? 0 : 1);
  const real_mask exit_xy = y_sooner ? int_of(iy > 0.0f ? 3 : 2) : int_of(ix > 0.0f ? 1 : 0);
  Span span;
  span.t_enter = z_later ? near_z : enter;
  span.t_exit = z_sooner ? far_z : exit;
  span.surface_enter = z_later ? int_of(iz > 0.0f ? 4 : 5) : enter_xy;
  span.surface_exit = z_sooner ? int_of(iz > 0.0f ? 5 : 4) : exit_xy;
  span.enter = span.exit = span.t_enter <= span.t_exit;
  return span;
}

SPAN_HIT(box)

#endif
