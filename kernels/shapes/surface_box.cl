// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Boxes have the surfaces 0 and 1 at the least and greatest x, 2 and 3 y, 4 and 5 z. uv, seen from
// outside: v up z (faces across z: y), u to the right, both from 0 to 1 over the face; dpdu x dpdv
// points outward.
#ifndef CAPLET_SHAPES_SURFACE_BOX_CL
#define CAPLET_SHAPES_SURFACE_BOX_CL

#include "shapes/surface_local.cl"

// The face's own coordinate is the box's and the others are clamped to it, so the point is on the
// box as stored, without rounding.
static inline LocalSurface surface_box(const SurfaceQuery* q) {
  const float3 low = box_low(q->data), high = box_high(q->data), size = high - low;
  const uint axis = q->surface >> 1;
  const int greatest = (int)(q->surface & 1u);
  const float sign = greatest ? 1.0f : -1.0f;
  float3 p = clamp(q->x, low, high);
  const float3 face = greatest ? high : low;
  const float3 share = (float3)(size.x > 0.0f ? (p.x - low.x) / size.x : 0.0f,
                                size.y > 0.0f ? (p.y - low.y) / size.y : 0.0f,
                                size.z > 0.0f ? (p.z - low.z) / size.z : 0.0f);
  LocalSurface s;
  float u;
  if (axis == 0u) {
    p.x = face.x;
    s.ng = (float3)(sign, 0.0f, 0.0f);
    u = greatest ? share.y : 1.0f - share.y;
    s.dpdu = (float3)(0.0f, sign * size.y, 0.0f);
  } else if (axis == 1u) {
    p.y = face.y;
    s.ng = (float3)(0.0f, sign, 0.0f);
    u = greatest ? 1.0f - share.x : share.x;
    s.dpdu = (float3)(-sign * size.x, 0.0f, 0.0f);
  } else {
    p.z = face.z;
    s.ng = (float3)(0.0f, 0.0f, sign);
    u = greatest ? share.x : 1.0f - share.x;
    s.dpdu = (float3)(sign * size.x, 0.0f, 0.0f);
  }
  s.ns = s.ng;
  s.p = p;
  s.dpdv = axis == 2u ? (float3)(0.0f, size.y, 0.0f) : (float3)(0.0f, 0.0f, size.z);
  s.uv = clamp((float2)(u, axis == 2u ? share.y : share.z), 0.0f, 1.0f);
  // Nothing is rounded here; the error is that of rays that start here (8 eps |o - c| at the most).
  s.error = CAPLET_EPS * (8.0f * norm1(size) + 4.0f * norm1(s.p));
  return s;
}

#endif
