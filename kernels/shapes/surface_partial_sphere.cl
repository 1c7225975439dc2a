// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Computes points of a partial sphere: radius, zmin, zmax, phimax. uv is as pbrt's: u = phi /
// phimax, v = (theta - theta(zmin)) / (theta(zmax) - theta(zmin)) with the angle theta from +z; the
// normal points outward.
#ifndef CAPLET_SHAPES_SURFACE_PARTIAL_SPHERE_CL
#define CAPLET_SHAPES_SURFACE_PARTIAL_SPHERE_CL

#include "shapes/surface_local.cl"
#include "shapes/surface_turn.cl"

// Returns the angle from +z at height z on a sphere of radius r.
static inline float sphere_theta(float r, float z) {
  return atan2(sqrt(fmax(0.0f, (r - z) * (r + z))), z);
}

static inline LocalSurface surface_partial_sphere(const SurfaceQuery* q) {
  const float r = partial_sphere_r(q->data), phi_max = partial_sphere_phi_max(q->data);
  const float low = fmax(partial_sphere_z_min(q->data), -r),
              high = fmin(partial_sphere_z_max(q->data), r);
  LocalSurface s;
  const float3 n = unit_or(q->x, q->fallback);
  float phi;
  const float2 spoke = spoke_within_turn(n.x, n.y, phi_max, &phi);
  const float z = fmin(fmax(r * n.z, low), high);
  // Off the clips the point keeps its distance from the axis: near a pole z alone would not
  // determine it.
  const float rho =
      z == r * n.z ? r * sqrt(n.x * n.x + n.y * n.y) : sqrt(fmax(0.0f, (r - z) * (r + z)));
  s.p = (float3)(rho * spoke.x, rho * spoke.y, z);
  s.ng = s.ns = unit_or(s.p, n);
  const float theta0 = sphere_theta(r, low), theta1 = sphere_theta(r, high);
  s.uv = (float2)(share_of(phi, phi_max), share_of(atan2(rho, z) - theta0, theta1 - theta0));
  s.dpdu = phi_max * (float3)(-s.p.y, s.p.x, 0.0f);
  s.dpdv =
      rho > 0.0f ? (theta1 - theta0) * (float3)(z * spoke.x, z * spoke.y, -rho) : (float3)(0.0f);
  s.error = CAPLET_EPS * (32.0f * r + 4.0f * norm1(s.p));
  return s;
}

#endif
