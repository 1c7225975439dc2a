// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// A tapered capsule has p0, p1, and a radius at each end; the geometry is surface_capsule.cl's.
#ifndef CAPLET_SHAPES_SURFACE_TAPERED_CAPSULE_CL
#define CAPLET_SHAPES_SURFACE_TAPERED_CAPSULE_CL

#include "shapes/surface_capsule.cl"

static inline LocalSurface surface_tapered_capsule(const SurfaceQuery* q) {
  return round_cone_point(q, tapered_capsule_p0(q->data), tapered_capsule_p1(q->data),
                          tapered_capsule_r0(q->data), tapered_capsule_r1(q->data));
}

#endif
