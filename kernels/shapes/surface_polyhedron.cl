// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The surfaces of polyhedra are the planes in their order. uv is affine over each plane: its
// coefficients lie behind the planes.
#ifndef CAPLET_SHAPES_SURFACE_POLYHEDRON_CL
#define CAPLET_SHAPES_SURFACE_POLYHEDRON_CL

#include "shapes/surface_local.cl"

// Returns the point of face `face` nearest to v (relative to the centre; all corners are within
// `radius` of it). In the face's plane each other plane is a half-plane, and they are added one by
// one: where the nearest point so far is beyond one, the new nearest point is on that one's line,
// within the earlier ones (Seidel 1991). A hit is beyond an edge by its rounding alone, so this is
// done once or twice at most. Where a ray comes from so far that its rounding is larger than the
// solid, any point will do, so v is moved near. That keeps feet of perpendiculars exact, and ends
// the search where planes parallel but for rounding do not bound a line.
static inline float3 polyhedron_face_point(__global const float* planes, uint count, float radius,
                                           uint face, float3 v) {
  const float4 own = vload4(face, planes);
  const float away = max3(fabs(v));
  if (away > 2.0f * radius) v *= 2.0f * radius / away;
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
    float high = 8.0f * radius / sqrt(squared), low = -high;
    for (uint k = 0; k < j; k++) {
      const float4 earlier = vload4(k, planes);
      const float along = dot(earlier.xyz, line),
                  bound = (earlier.w - dot(earlier.xyz, foot)) / along;
      if (k == face) continue;
      if (along > 0.0f) high = fmin(high, bound);
      if (along < 0.0f) low = fmax(low, bound);
    }
    v = foot + fmin(fmax(0.0f, low), high) * line;
  }
  return v;
}

static inline LocalSurface surface_polyhedron(const SurfaceQuery* q) {
  __global const float* head = floats_at(q->leaves, polyhedron_begin(q->data));
  __global const float* planes = head + 8;
  const float3 center = load3(head), normal = load3(planes + 4u * q->surface);
  const uint count = as_uint(head[3]);
  const float3 v = polyhedron_face_point(planes, count, head[4], q->surface, q->x - center);
  const float8 along = vload8(q->surface, planes + (4u * count + 7u) / 8u * 8u);
  // In the plane, u is constant along cross(U, n) and v along cross(V, n).
  const float3 n = unit_or(normal, q->fallback), across_u = cross(along.s012, n),
               across_v = cross(along.s456, n);
  LocalSurface s;
  s.ng = s.ns = n;
  s.p = center + v;
  s.dpdu = across_v / dot(along.s012, across_v);
  s.dpdv = across_u / dot(along.s456, across_u);
  if (!(norm1(s.dpdu) + norm1(s.dpdv) < INFINITY))
    s.dpdu = s.dpdv = (float3)(0.0f);  // a solid so small that they are no floats
  s.uv = clamp((float2)(dot(v, along.s012) + along.s3, dot(v, along.s456) + along.s7), 0.0f, 1.0f);
  s.error = CAPLET_EPS * (32.0f * norm1(v) + 4.0f * norm1(s.p));
  return s;
}

#endif
