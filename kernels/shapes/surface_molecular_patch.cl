// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Computes points of a patch of a molecular surface. The normal points out of the molecule. uv of
// spheres is that of a whole sphere; on tori u = phi / phi_max runs around the axis and v from one
// end of the tube's arc to the other.
#ifndef CAPLET_SHAPES_SURFACE_MOLECULAR_PATCH_CL
#define CAPLET_SHAPES_SURFACE_MOLECULAR_PATCH_CL

#include "shapes/surface_sphere.cl"
#include "shapes/surface_turn.cl"

static inline LocalSurface surface_torus_patch(const SurfaceQuery* q, __global const float* data) {
  const float3 center = load3(data), axis = load3(data + 8), start = load3(data + 12);
  const float minor = data[3], major = data[5], phi_max = data[11];
  const float theta_min = data[20], theta_max = data[21];
  const float3 w = q->x - center, side = cross(axis, start);
  // Made of `start` and `side`, it is across the axis however near to that x is.
  const float3 spoke = unit_or(dot(w, start) * start + dot(w, side) * side, start);
  const float3 tube = q->x - (center + major * spoke);
  LocalSurface s;
  float3 outward = unit_or(tube, -q->fallback);  // of the tube
  float height = dot(outward, axis), out = dot(outward, spoke);
  // A tube wider than its circle ends at the axis, which a rounded x may lie beyond.
  if (minor * out < -major) {
    out = -major / minor;
    height = copysign(sqrt(1.0f - out * out), height);
    outward = out * spoke + height * axis;
  }
  s.ng = s.ns = -outward;
  s.p = center + (major * spoke + minor * outward);
  const float x = dot(spoke, start), y = dot(spoke, side);
  float phi = atan2(y, x);
  if (phi < 0.0f) phi += 2.0f * CAPLET_PI;
  if (phi - phi_max > 2.0f * CAPLET_PI - phi) phi = 0.0f;  // beyond an end: the nearer one
  float theta = atan2(height, out);
  if (theta < 0.0f) theta += 2.0f * CAPLET_PI;
  s.uv = (float2)(share_of(phi, phi_max), share_of(theta - theta_min, theta_max - theta_min));
  s.dpdu = phi_max * cross(axis, s.p - center);
  s.dpdv = (theta_max - theta_min) * minor * (out * axis - height * spoke);
  s.error = CAPLET_EPS * (32.0f * (major + minor) + 4.0f * norm1(s.p));
  return s;
}

static inline LocalSurface surface_molecular_patch(const SurfaceQuery* q) {
  __global const float* data = floats_at(q->leaves, molecular_patch_begin(q->data));
  if (as_uint(data[4]) == CAPLET_NONE) return surface_torus_patch(q, data);
  LocalSurface s = sphere_point(q, load3(data), data[3], own_z(q->space), 0.0f);
  if (data[5] != 0.0f) s.ng = s.ns = -s.ng;
  return s;
}

#endif
