// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This file makes the records that queries return of a hit.
#ifndef CAPLET_STAGES_PICK_RECORD_CL
#define CAPLET_STAGES_PICK_RECORD_CL

#include "groups.cl"
#include "shapes/surface.cl"

// Returns whether the two sides of a shape are told apart by a normal alone.
static inline int shape_is_sheet(uint shape) {
  switch (shape) {
#define SHAPE(name, traits) \
  case shape_##name:        \
    return ((traits)&trait_sheet) != 0;
#include "shared/shapes.def"
#undef SHAPE
    default: return 0;
  }
}

// Returns the record of a hit of `ray`, or of a miss. The normal points against the ray, from
// inside too.
static inline PickRecord pick_record(const Tree* tree, const Surfaces* surfaces,
                                     const RayRecord* ray, const HitRecord* hit) {
  PickRecord out = {INFINITY, 0.0f, 0.0f, 0.0f, CAPLET_NONE,        CAPLET_NONE,
                    0,        0,    0,    0,    {0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f}};
  if (hit->slot == CAPLET_NONE) return out;
  const Surface s = surface_at(tree, surfaces, ray, hit);
  __global const GeometryRecord* geometry = surfaces->geometries + s.geometry;
  const float3 normal = dot(s.ng, (float3)(ray->dx, ray->dy, ray->dz)) > 0.0f ? -s.ng : s.ng;
  out.t = hit->t;
  out.error = s.error;
  out.u = s.uv.x;
  out.v = s.uv.y;
  out.object = out.shape = geometry->object;
  if (hit->instance != CAPLET_NONE && tree->instances[hit->instance].object != CAPLET_NONE)
    out.object = tree->instances[hit->instance].object;
  out.primitive = s.primitive - geometry->primitive_begin;
  out.surface = s.surface;
  out.material = s.material;
  out.leaving = s.leaving ? 1u : 0u;
  if (shape_is_sheet(geometry->shape) && (geometry->flags & CAPLET_GEOMETRY_FLIP_NORMAL))
    out.leaving ^= 1u;
  vstore3(s.p, 0, out.point);
  vstore3(normal, 0, out.normal);
  return out;
}

#endif
