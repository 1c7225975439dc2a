// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Computes points of a disk: centre, unit normal, radius. uv is as pbrt's disk, of its own space: u
// = angle from +x / 2 pi, v = 1 - distance from the centre / radius.
#ifndef CAPLET_SHAPES_SURFACE_DISK_CL
#define CAPLET_SHAPES_SURFACE_DISK_CL

#include "shapes/surface_local.cl"

static inline LocalSurface surface_disk(const SurfaceQuery* q) {
  const float3 center = disk_c(q->data), normal = disk_n(q->data);
  const float radius = disk_r(q->data);
  const Frame turn = turn_frame(q->space, normal);
  LocalSurface s;
  const float3 v = q->x - center;
  const float3 in_plane = v - dot(v, normal) * normal;
  const float3 flat_spoke = in_plane - dot(in_plane, normal) * normal;
  const float distance = fmin(length(flat_spoke), radius);
  // The hit's rounding may lie beyond the rim; the point does not.
  const float3 spoke =
      distance < radius ? flat_spoke : unit_or(flat_spoke, (float3)(0.0f)) * radius;
  s.ng = s.ns = normal;
  s.p = center + spoke;
  s.uv = (float2)(distance > 0.0f ? turn_around(&turn, spoke / distance) : 0.0f,
                  radius > 0.0f ? fmax(0.0f, 1.0f - distance / radius) : 0.0f);
  s.dpdu = along_turn(&turn, spoke);
  s.dpdv = -radius * unit_or(spoke, (float3)(0.0f));
  s.error = CAPLET_EPS * (12.0f * radius + 4.0f * norm1(s.p));
  return s;
}

#endif
