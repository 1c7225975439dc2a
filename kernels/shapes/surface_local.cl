// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// What the surface functions of all shapes share: the result, and unit vectors that never become NaN.
#ifndef CAPLET_SHAPES_SURFACE_LOCAL_CL
#define CAPLET_SHAPES_SURFACE_LOCAL_CL

#include "math/vector.cl"

// A point of a shape in the space in which its data is stored (world, or an instance's object space).
typedef struct {
  float3 p;     // on the surface, within `error`
  float3 ng;    // unit; outward of solids, by winding or stored normal for open shapes
  float3 ns;    // unit shading normal, on ng's side
  float3 dpdu;  // derivative of the point by uv.x; zero where it is undefined (poles)
  float2 uv;
  float error;  // bound on the distance of p from the true surface (docs/numerics.md, "Surface points")
} LocalSurface;

static inline float norm1(float3 v) { return fabs(v.x) + fabs(v.y) + fabs(v.z); }

// v / |v| for any magnitude; `otherwise` when v is zero or not finite.
static inline float3 unit_or(float3 v, float3 otherwise) {
  const float scale = max3(fabs(v));
  if (!(scale > 0.0f && scale < INFINITY)) return otherwise;
  v = v / scale;
  const float length_squared = dot(v, v);  // in [1, 3]
  return length_squared < 4.0f ? v / sqrt(length_squared) : otherwise;
}

// Some unit vector perpendicular to the unit vector n.
static inline float3 perpendicular(float3 n) { return frame_from_normal(n).s; }

// Angle of `n` around `axis` (both unit), over a full turn: in [0, 1), zero along frame_from_normal(axis).s.
static inline float turn_around(float3 axis, float3 n) {
  const Frame f = frame_from_normal(axis);
  const float turn = atan2(dot(n, f.t), dot(n, f.s)) * (0.5f * CAPLET_INV_PI);
  return turn < 0.0f ? fmin(turn + 1.0f, 0x1.fffffep-1f) : turn;
}

// Angle between the unit vectors `axis` and `n`, in [0, pi]; accurate near the poles.
static inline float angle_between(float3 axis, float3 n) { return atan2(length(n - axis * dot(n, axis)), dot(n, axis)); }

#endif
