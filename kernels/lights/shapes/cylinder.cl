// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Samples points on a cylinder with flat or open ends, uniformly over the area that emits. A long
// tube fills little of the ball around it, so it is not sampled by that ball.
#ifndef CAPLET_LIGHTS_SHAPES_CYLINDER_CL
#define CAPLET_LIGHTS_SHAPES_CYLINDER_CL

#include "groups.cl"
#include "math/vector.cl"
#include "shapes/surface_local.cl"

// Returns the areas of the side and of the ends that emit.
static inline float3 cylinder_areas(const Surfaces* surfaces,
                                    __global const GeometryRecord* geometry,
                                    __global const float* data) {
  const float r = cylinder_r(data);
  float3 area = (float3)(2.0f * CAPLET_PI * r * length(cylinder_p1(data) - cylinder_p0(data)),
                         cylinder_cap0(data) == CAPLET_CAP_OPEN ? 0.0f : CAPLET_PI * r * r,
                         cylinder_cap1(data) == CAPLET_CAP_OPEN ? 0.0f : CAPLET_PI * r * r);
  if (geometry->surface_begin == CAPLET_NONE) return area;
  __global const uint* rows = surfaces->surface_materials + geometry->surface_begin;
  if (rows[0] & CAPLET_SURFACE_DARK) area.x = 0.0f;
  if (rows[1] & CAPLET_SURFACE_DARK) area.y = 0.0f;
  if (rows[2] & CAPLET_SURFACE_DARK) area.z = 0.0f;
  return area;
}

// Returns the density per area of every point that emits.
static inline float cylinder_density(float3 areas) {
  const float total = areas.x + areas.y + areas.z;
  return total > 0.0f ? 1.0f / total : 0.0f;
}

// Samples x on the surface, n outward (object space), and which surface: the side or an end.
// Returns the density per area, 0 when nothing emits.
static inline float cylinder_sample(__global const float* data, float3 areas, float2 u, float3* x,
                                    float3* n, uint* surface) {
  const float density = cylinder_density(areas);
  if (!(density > 0.0f)) return 0.0f;
  const float3 p0 = cylinder_p0(data), p1 = cylinder_p1(data);
  const float r = cylinder_r(data);
  const float3 axis = unit_or(p1 - p0, (float3)(0.0f, 0.0f, 1.0f));
  const Frame frame = frame_from_normal(axis);
  const float at = u.x * (areas.x + areas.y + areas.z);
  if (at < areas.x) {
    const float phi = 2.0f * CAPLET_PI * u.y;
    *surface = 0u;
    *n = frame.s * cos(phi) + frame.t * sin(phi);
    *x = p0 + (at / areas.x) * (p1 - p0) + r * *n;
    return density;
  }
  const int first = at - areas.x < areas.y;
  const float rest = first ? (at - areas.x) / areas.y : (at - areas.x - areas.y) / areas.z;
  const float2 d = r * sample_disk((float2)(fmin(rest, 0x1.fffffep-1f), u.y));
  *surface = first ? 1u : 2u;
  *n = first ? -axis : axis;
  *x = (first ? p0 : p1) + (frame.s * d.x + frame.t * d.y);
  return density;
}

#endif
