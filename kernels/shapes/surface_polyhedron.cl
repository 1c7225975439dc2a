// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Surfaces of polyhedra: the planes in their order. uv: across the plane's normal, (1/2 1/2) at the foot of the perpendicular
// from the centre, 0 and 1 a bounding radius to either side; u along frame_from_normal(n).s, v along its t.
#ifndef CAPLET_SHAPES_SURFACE_POLYHEDRON_CL
#define CAPLET_SHAPES_SURFACE_POLYHEDRON_CL

#include "shapes/surface_local.cl"

// The point of face `face` nearest to v (relative to the centre). In the face's plane each other plane is a half-plane, and they
// are added one by one: where the nearest point so far is beyond one, the new nearest point is on that one's line, within the
// earlier ones (Seidel 1991). A hit is beyond an edge by its rounding alone, so this is done once or twice at most.
static inline float3 polyhedron_face_point(__global const float* planes, uint count, uint face, float3 v) {
  const float4 own = vload4(face, planes);
  v -= (dot(own.xyz, v) - own.w) * own.xyz;
  v -= (dot(own.xyz, v) - own.w) * own.xyz;
  const float3 start = v;
  for (uint j = 0; j < count; j++) {
    const float4 other = vload4(j, planes);
    if (j == face || dot(other.xyz, v) <= other.w) continue;
    const float3 slope = other.xyz - dot(other.xyz, own.xyz) * own.xyz;
    const float squared = dot(slope, slope);
    if (!(squared > 0x1p-40f)) continue;  // the same plane to rounding
    const float3 foot = start - ((dot(other.xyz, start) - other.w) / squared) * slope;
    const float3 line = cross(own.xyz, slope);
    float low = -INFINITY, high = INFINITY;
    for (uint k = 0; k < j; k++) {
      const float4 earlier = vload4(k, planes);
      const float along = dot(earlier.xyz, line), bound = (earlier.w - dot(earlier.xyz, foot)) / along;
      if (k == face) continue;
      if (along > 0.0f) high = fmin(high, bound);
      if (along < 0.0f) low = fmax(low, bound);
    }
    v = foot + fmin(fmax(0.0f, low), high) * line;
  }
  return v;
}

static inline LocalSurface surface_polyhedron(const SurfaceQuery* q) {
  __global const float* head = q->g->leaves + as_uint(q->data[0]);
  __global const float* planes = head + 8;
  const float3 center = load3(head), normal = load3(planes + 4u * q->surface);
  const float3 v = polyhedron_face_point(planes, as_uint(head[3]), q->surface, q->x - center);
  const float width = 2.0f * head[4];
  const Frame frame = frame_from_normal(normal);
  LocalSurface s;
  s.ng = s.ns = unit_or(normal, q->fallback);
  s.p = center + v;
  s.dpdu = width * frame.s;
  s.dpdv = width * frame.t;
  s.uv = clamp(0.5f + (float2)(dot(v, frame.s), dot(v, frame.t)) / width, 0.0f, 1.0f);
  s.error = CAPLET_EPS * (32.0f * norm1(v) + 4.0f * norm1(s.p));
  return s;
}

#endif
