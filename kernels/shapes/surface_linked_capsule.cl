// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// A linked capsule has the surface of the tapered capsule between two points of its leaf block
// (shapes.h).
#ifndef CAPLET_SHAPES_SURFACE_LINKED_CAPSULE_CL
#define CAPLET_SHAPES_SURFACE_LINKED_CAPSULE_CL

#include "shapes/surface_capsule.cl"

static inline LocalSurface surface_linked_capsule(const SurfaceQuery* q) {
  __global const float* block = q->data - 8;  // moved by the lane (lane_data)
  __global const float *x = block + CAPLET_LINK_X, *y = block + CAPLET_LINK_Y;
  __global const float *z = block + CAPLET_LINK_Z, *r = block + CAPLET_LINK_R;
  return round_cone_point(q, (float3)(x[0], y[0], z[0]), (float3)(x[1], y[1], z[1]), r[0], r[1]);
}

#endif
