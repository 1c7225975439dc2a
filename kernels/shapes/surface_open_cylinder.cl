// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Computes points of an open cylinder: radius, zmin, zmax, phimax. uv is as pbrt's: u = phi /
// phimax, v = (z - zmin) / (zmax - zmin); the normal points outward.
#ifndef CAPLET_SHAPES_SURFACE_OPEN_CYLINDER_CL
#define CAPLET_SHAPES_SURFACE_OPEN_CYLINDER_CL

#include "shapes/surface_local.cl"
#include "shapes/surface_turn.cl"

static inline LocalSurface surface_open_cylinder(const SurfaceQuery* q) {
  const float r = open_cylinder_r(q->data), phi_max = open_cylinder_phi_max(q->data);
  const float low = open_cylinder_z_min(q->data), high = open_cylinder_z_max(q->data);
  LocalSurface s;
  float phi;
  const float2 spoke = spoke_within_turn(q->x.x, q->x.y, phi_max, &phi);
  const float z = fmin(fmax(q->x.z, low), high);
  s.p = (float3)(r * spoke.x, r * spoke.y, z);
  s.ng = s.ns = (float3)(spoke.x, spoke.y, 0.0f);
  s.uv = (float2)(share_of(phi, phi_max), share_of(z - low, high - low));
  s.dpdu = phi_max * (float3)(-s.p.y, s.p.x, 0.0f);
  s.dpdv = (float3)(0.0f, 0.0f, high - low);
  s.error = CAPLET_EPS * (32.0f * r + 8.0f * (high - low) + 4.0f * norm1(s.p));
  return s;
}

#endif
