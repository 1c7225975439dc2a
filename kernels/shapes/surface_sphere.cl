// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Sphere: centre, radius. uv as pbrt's full sphere: u around +z from +x, v = 0 at -z, 1 at +z (by angle).
#ifndef CAPLET_SHAPES_SURFACE_SPHERE_CL
#define CAPLET_SHAPES_SURFACE_SPHERE_CL

#include "shapes/surface_local.cl"

// The sphere of `radius` around `center` at x projected from its centre; `fallback`: unit normal where x is the centre. uv about
// `axis` (unit).
static inline LocalSurface sphere_point(float3 center, float radius, float3 axis, float3 x, float3 fallback) {
  LocalSurface s;
  s.ng = unit_or(x - center, fallback);
  s.ns = s.ng;
  s.p = center + radius * s.ng;
  s.uv = (float2)(turn_around(axis, s.ng), 1.0f - CAPLET_INV_PI * angle_between(axis, s.ng));
  s.dpdu = 2.0f * CAPLET_PI * radius * cross(axis, s.ng);
  // v rises from the pole against the axis to the one along it.
  s.dpdv = CAPLET_PI * radius * unit_or(axis - dot(axis, s.ng) * s.ng, (float3)(0.0f));
  s.error = CAPLET_EPS * (32.0f * radius + 4.0f * norm1(s.p));
  return s;
}

static inline LocalSurface surface_sphere(const SurfaceQuery* q) {
  return sphere_point(data3(q->data, 0), q->data[24], (float3)(0.0f, 0.0f, 1.0f), q->x, q->fallback);
}

#endif
