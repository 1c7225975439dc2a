// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Computes points of a sphere: centre, radius. uv is as pbrt's full sphere: u around +z from +x, v
// = 0 at -z, 1 at +z (by angle), of its own space.
#ifndef CAPLET_SHAPES_SURFACE_SPHERE_CL
#define CAPLET_SHAPES_SURFACE_SPHERE_CL

#include "shapes/surface_local.cl"

// Returns the point of the sphere of `radius` around `center` that is q->x projected from its
// centre. uv is about `axis` (unit). end: which of a capsule's it is, 0 or 1.
static inline LocalSurface sphere_point(const SurfaceQuery* q, float3 center, float radius,
                                        float3 axis, float end) {
  const Frame turn = turn_frame(q->space, axis);
  LocalSurface s;
  s.ng = unit_or(q->x - center, q->fallback);
  s.ns = s.ng;
  s.p = center + radius * s.ng;
  s.uv = (float2)(turn_around(&turn, s.ng), 1.0f - CAPLET_INV_PI * angle_between(axis, s.ng));
  s.dpdu = along_turn(&turn, radius * s.ng);
  // v rises from the pole against the axis to the one along it.
  s.dpdv = CAPLET_PI * radius * unit_or(axis - dot(axis, s.ng) * s.ng, (float3)(0.0f));
  s.error = CAPLET_EPS * (32.0f * radius + 4.0f * norm1(s.p));
  if (any_chain && q->chain_u) chain_uv(q, axis, end, 1.0f, radius, radius, &s);
  return s;
}

static inline LocalSurface surface_sphere(const SurfaceQuery* q) {
  return sphere_point(q, sphere_c(q->data), sphere_r(q->data), own_z(q->space), 0.0f);
}

#endif
