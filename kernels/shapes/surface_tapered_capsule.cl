// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Tapered capsule: p0, p1, and a radius at each end; the geometry is surface_capsule.cl's.
#ifndef CAPLET_SHAPES_SURFACE_TAPERED_CAPSULE_CL
#define CAPLET_SHAPES_SURFACE_TAPERED_CAPSULE_CL

#include "shapes/surface_capsule.cl"

static inline LocalSurface surface_tapered_capsule(__global const float* data, float3 x, float3 fallback) {
  return round_cone_point((float3)(data[0], data[8], data[16]), (float3)(data[24], data[32], data[40]), data[48], data[56], x,
                          fallback);
}

#endif
