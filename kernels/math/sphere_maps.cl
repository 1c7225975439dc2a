// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This file maps between directions and the unit square.
#ifndef CAPLET_MATH_SPHERE_MAPS_CL
#define CAPLET_MATH_SPHERE_MAPS_CL

#include "math/vector.cl"

// This is the equal-area octahedral map (Clarberg, "Fast equal-area mapping of the (hemi)sphere
// using SIMD", 2008): the diamond |u| + |v| <= r of [-1, 1]^2 has the share r^2 / 2 of the square,
// the polar cap 1 - z <= r^2 the same share of the sphere.
static inline float3 square_to_sphere(float2 uv) {
  const float2 signed_uv = 2.0f * uv - 1.0f;
  const float2 a = fabs(signed_uv);
  const float fold = 1.0f - (a.x + a.y);
  const float r = 1.0f - fabs(fold);
  const float phi = (r == 0.0f ? 1.0f : (a.y - a.x) / r + 1.0f) * (0.25f * CAPLET_PI);
  const float across = r * sqrt(fmax(0.0f, 2.0f - r * r));
  return (float3)(copysign(cos(phi) * across, signed_uv.x),
                  copysign(sin(phi) * across, signed_uv.y), copysign(1.0f - r * r, fold));
}

static inline float2 sphere_to_square(float3 d) {
  // The other two coordinates give 1 - |z| without cancellation near the poles.
  const float r = sqrt(fmax(0.0f, (d.x * d.x + d.y * d.y) / (1.0f + fabs(d.z))));
  const float v = r * atan2(fabs(d.y), fabs(d.x)) * (2.0f * CAPLET_INV_PI);
  float2 uv = (float2)(r - v, v);
  if (d.z < 0.0f) uv = (float2)(1.0f - uv.y, 1.0f - uv.x);
  return clamp(0.5f * ((float2)(copysign(uv.x, d.x), copysign(uv.y, d.y)) + 1.0f), 0.0f, 1.0f);
}

// In latitude-longitude u = phi / 2 pi, v = theta / pi, z up.
static inline float3 latlong_to_sphere(float2 uv, float* sine) {
  const float phi = 2.0f * CAPLET_PI * uv.x, theta = CAPLET_PI * uv.y;
  *sine = sin(theta);
  return (float3)(*sine * cos(phi), *sine * sin(phi), cos(theta));
}

static inline float2 sphere_to_latlong(float3 d, float* sine) {
  *sine = sqrt(d.x * d.x + d.y * d.y);
  float u = atan2(d.y, d.x) * (0.5f * CAPLET_INV_PI);
  if (u < 0.0f) u += 1.0f;
  return (float2)(fmin(u, 1.0f), atan2(*sine, d.z) * CAPLET_INV_PI);
}

#endif
