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

// Returns the record of a hit, or of a miss, without what is where: no point, normal, uv or error.
static inline PickRecord pick_identity(const Tree* tree, const Surfaces* surfaces,
                                       const HitRecord* hit) {
  PickRecord out = {INFINITY, 0.0f, 0.0f, 0.0f, CAPLET_NONE,        CAPLET_NONE,
                    0,        0,    0,    0,    {0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f}};
  if (hit->slot == CAPLET_NONE) return out;
  const uint primitive = primitive_at(tree, hit->slot);
  __global const GeometryRecord* geometry = surfaces->geometries + geometry_of(surfaces, primitive);
  out.t = hit->t;
  out.object = out.shape = geometry->object;
  if (CAPLET_HAS_SHAPE(shape_instance) && hit->instance != CAPLET_NONE &&
      tree->instances[hit->instance].object != CAPLET_NONE)
    out.object = tree->instances[hit->instance].object;
  out.primitive = primitive - geometry->primitive_begin;
  out.surface = hit->surface & CAPLET_SURFACE_MASK;
  out.material = geometry->material;
  if (geometry->surface_begin != CAPLET_NONE)
    out.material =
        surfaces->surface_materials[geometry->surface_begin + out.surface] & ~CAPLET_SURFACE_DARK;
  out.leaving = (hit->surface & CAPLET_LEAVING) != 0 ? 1u : 0u;
  if (shape_is_sheet(geometry->shape) && (geometry->flags & CAPLET_GEOMETRY_FLIP_NORMAL))
    out.leaving ^= 1u;
  return out;
}

// Returns the record of a hit of `ray`, or of a miss. The normal points against the ray, from
// inside too.
static inline PickRecord pick_record(const Tree* tree, const Surfaces* surfaces,
                                     const RayRecord* ray, const HitRecord* hit) {
  PickRecord out = pick_identity(tree, surfaces, hit);
  if (hit->slot == CAPLET_NONE) return out;
  const Surface s = surface_at(tree, surfaces, ray, hit);
  const float3 normal = dot(s.ng, (float3)(ray->dx, ray->dy, ray->dz)) > 0.0f ? -s.ng : s.ng;
  out.error = s.error;
  out.u = s.uv.x;
  out.v = s.uv.y;
  vstore3(s.p, 0, out.point);
  vstore3(normal, 0, out.normal);
  return out;
}

#endif
