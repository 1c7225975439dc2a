// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Computes the surface of a capsule whose ends and radii change with time: at one time it is that
// of a sphere, a capsule or a tapered capsule.
#ifndef CAPLET_SHAPES_SURFACE_MOVING_CAPSULE_CL
#define CAPLET_SHAPES_SURFACE_MOVING_CAPSULE_CL

#include "shapes/moving_ends.cl"
#include "shapes/surface_capsule.cl"

static inline LocalSurface surface_moving_capsule(const SurfaceQuery* q) {
  const float8 ends =
      moving_ends(q->leaves, moving_capsule_begin(q->data), moving_capsule_times(q->data),
                  moving_capsule_segments(q->data), q->time);
  const float3 p0 = ends.s012, p1 = ends.s456;
  if (all(p0 == p1)) return sphere_point(q, p0, fmax(ends.s3, ends.s7), own_z(q->space), 0.0f);
  return round_cone_point(q, p0, p1, ends.s3, ends.s7);
}

#endif
