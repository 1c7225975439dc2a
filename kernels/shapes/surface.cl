// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The surface where a ray hit: computed once, from the tiny record that traversal leaves. Bounds: docs/numerics.md, "Surface
// points".
#ifndef CAPLET_SHAPES_SURFACE_CL
#define CAPLET_SHAPES_SURFACE_CL

#include "globals.cl"
#include "shapes/surface_capsule.cl"
#include "shapes/surface_disk.cl"
#include "shapes/surface_sphere.cl"
#include "shapes/surface_tapered_capsule.cl"
#include "shapes/surface_triangle.cl"

// World space. p lies on the surface within `error`: p +- ng * error is on the intended side. ng points outward of solids, and by
// winding / +z for open shapes, and ReverseOrientation turns it; ns on the same side. light: index into `lights` or CAPLET_NONE.
typedef struct {
  float3 p, ng, ns, dpdu;
  float2 uv;
  float error;
  uint geometry, primitive, surface, light;
  int leaving;
} Surface;

// The point (before ReverseOrientation) of primitive `primitive` (data at leaves[slot + 8 * row]) nearest to x in its own space.
// `fallback`: a unit vector, the normal where x leaves it undefined.
static inline LocalSurface surface_local(const Globals* g, const GeometryRecord geometry, uint primitive, uint slot, float3 x,
                                         float3 fallback) {
  __global const float* data = g->leaves + slot + 8u;
  switch (geometry.shape) {
    case shape_sphere:
      return surface_sphere(data, x, fallback);
    case shape_capsule:
      return surface_capsule(data, x, fallback);
    case shape_tapered_capsule:
      return surface_tapered_capsule(data, x, fallback);
    case shape_disk:
      return surface_disk(data, x);
    default:
      return surface_triangle(g, geometry, primitive, data, x, fallback);
  }
}

// Sum over columns of |m| |p|, translation included: what roundings of transform_point(m, p) are proportional to.
static inline float3 transform_magnitude(__global const float* m, float3 p) {
  const float3 a = fabs(p);
  return (float3)(fabs(m[0]) * a.x + fabs(m[1]) * a.y + fabs(m[2]) * a.z + fabs(m[3]),
                  fabs(m[4]) * a.x + fabs(m[5]) * a.y + fabs(m[6]) * a.z + fabs(m[7]),
                  fabs(m[8]) * a.x + fabs(m[9]) * a.y + fabs(m[10]) * a.z + fabs(m[11]));
}

// Takes a surface point of an instance's object space to world space.
static inline LocalSurface surface_to_world(__global const InstanceRecord* instance, LocalSurface s) {
  __global const float* to_world = instance->world_from_object;
  __global const float* to_object = instance->object_from_world;
  const float3 magnitude = transform_magnitude(to_world, s.p);
  const float3 normal = unit_or(transform_transposed(to_object, s.ng), s.ng);
  const float3 shading = unit_or(transform_transposed(to_object, s.ns), normal);
  // Object-space uncertainty: that of the point, and the rounding of the way there and back with both rounded matrices.
  const float object_error = s.error + 8.0f * CAPLET_EPS * norm1(transform_magnitude(to_object, magnitude));
  LocalSurface out = s;
  out.p = transform_point(to_world, s.p);
  out.dpdu = transform_vector(to_world, s.dpdu);
  out.ng = normal;
  out.ns = dot(shading, normal) < 0.0f ? -shading : shading;
  out.error = length(transform_transposed(to_world, normal)) * object_error + 8.0f * CAPLET_EPS * dot(fabs(normal), magnitude);
  return out;
}

// The surface at a hit of `ray` (hit->slot is not CAPLET_NONE).
static inline Surface surface_at(const Globals* g, const RayRecord* ray, const HitRecord* hit) {
  float3 o = (float3)(ray->ox, ray->oy, ray->oz);
  float3 d = (float3)(ray->dx, ray->dy, ray->dz);
  const int placed = hit->instance != CAPLET_NONE;
  if (placed) {
    o = transform_point(g->instances[hit->instance].object_from_world, o);
    d = transform_vector(g->instances[hit->instance].object_from_world, d);
  }
  const uint primitive = as_uint(g->leaves[hit->slot]);
  const uint index = g->primitive_geometry[primitive];
  const GeometryRecord geometry = g->geometries[index];
  const int leaving = (int)((hit->surface >> 16) & 1u);
  const float3 backward = unit_or(leaving ? d : -d, (float3)(0.0f, 0.0f, 1.0f));
  LocalSurface found = surface_local(g, geometry, primitive, hit->slot, o + hit->t * d, backward);
  if (geometry.flags & CAPLET_GEOMETRY_FLIP_NORMAL) {
    found.ng = -found.ng;
    found.ns = -found.ns;
  }
  if (placed) found = surface_to_world(g->instances + hit->instance, found);

  Surface s;
  s.p = found.p;
  s.ng = found.ng;
  s.ns = found.ns;
  s.dpdu = found.dpdu;
  s.uv = found.uv;
  s.error = found.error;
  s.geometry = index;
  s.primitive = primitive;
  s.surface = hit->surface & 0xffffu;
  s.leaving = leaving;
  const uint base = placed ? g->instances[hit->instance].light_base : 0u;
  s.light = geometry.light_offset == CAPLET_NONE || base == CAPLET_NONE
                ? CAPLET_NONE
                : base + geometry.light_offset + (primitive - geometry.primitive_begin);
  return s;
}

// The next float away from zero movement: up when `step` > 0, down when < 0, x itself when 0.
static inline float round_along(float x, float step) {
  if (step == 0.0f || !isfinite(x)) return x;
  if (x == 0.0f) return step > 0.0f ? FLT_MIN : -FLT_MIN;
  return as_float(as_int(x) + ((x > 0.0f) == (step > 0.0f) ? 1 : -1));
}

// The origin for a ray that leaves p towards `direction`: moved by `error` to that side of the surface with normal ng, each
// component rounded further out, so that it never lands short (after Woo, Pearce and Ouellette 1996; Pharr, Jakob and Humphreys
// 2016, 3.9.5).
static inline float3 offset_origin(float3 p, float3 ng, float error, float3 direction) {
  const float3 step = (dot(direction, ng) < 0.0f ? -error : error) * ng;
  const float3 moved = p + step;
  return (float3)(round_along(moved.x, step.x), round_along(moved.y, step.y), round_along(moved.z, step.z));
}

#endif
