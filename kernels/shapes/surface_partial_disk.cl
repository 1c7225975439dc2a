// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Computes points of a partial disk: height, radius, inner radius, phimax. uv is as pbrt's: u = phi
// / phimax, v = (radius - distance) / (radius - inner); the normal is +z.
#ifndef CAPLET_SHAPES_SURFACE_PARTIAL_DISK_CL
#define CAPLET_SHAPES_SURFACE_PARTIAL_DISK_CL

#include "shapes/surface_local.cl"
#include "shapes/surface_turn.cl"

static inline LocalSurface surface_partial_disk(const SurfaceQuery* q) {
  const float height = partial_disk_height(q->data), r = partial_disk_r(q->data),
              inner = partial_disk_inner(q->data), phi_max = partial_disk_phi_max(q->data);
  LocalSurface s;
  float phi;
  const float2 spoke = spoke_within_turn(q->x.x, q->x.y, phi_max, &phi);
  const float rho = fmin(fmax(length(q->x.xy), inner), r);
  s.p = (float3)(rho * spoke.x, rho * spoke.y, height);
  s.ng = s.ns = (float3)(0.0f, 0.0f, 1.0f);
  s.uv = (float2)(share_of(phi, phi_max), share_of(r - rho, r - inner));
  s.dpdu = phi_max * (float3)(-s.p.y, s.p.x, 0.0f);
  s.dpdv = (float3)((inner - r) * spoke.x, (inner - r) * spoke.y, 0.0f);
  s.error = CAPLET_EPS * (12.0f * r + 4.0f * norm1(s.p));
  return s;
}

#endif
