// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Traces rays among shapes that do not stop all of them: a number that depends on the ray, the
// point and the primitive alone decides.
#ifndef CAPLET_TRACE_ALPHA_CL
#define CAPLET_TRACE_ALPHA_CL

#include "math/rng.cl"
#include "shapes/surface.cl"
#include "textures/textures.cl"
#include "trace/trace.cl"

// AlphaScene is the part of the scene that hits are tested with.
typedef struct {
  Tree tree;
  Surfaces surfaces;
  Spectra spectra;
  Materials materials;
} AlphaScene;

static inline int alpha_stops(const AlphaScene* scene, const RayRecord* ray, const HitRecord* hit) {
  const uint primitive = primitive_at(&scene->tree, hit->slot);
  const uint alpha = scene->surfaces.geometries[geometry_of(&scene->surfaces, primitive)].alpha;
  if (alpha == CAPLET_NONE) return 1;
  const Surface s = surface_at(&scene->tree, &scene->surfaces, ray, hit);
  const float chance = alpha_chance(&scene->materials, &scene->spectra, alpha, s.uv, s.p, s.ng);
  uint number = hash_combine(as_uint(ray->ox), as_uint(ray->oy));
  number = hash_combine(hash_combine(number, as_uint(ray->oz)), as_uint(ray->dx));
  number = hash_combine(hash_combine(number, as_uint(ray->dy)), as_uint(ray->dz));
  number = hash_combine(hash_combine(number, as_uint(hit->t)), primitive);
  return unit_float(number) < chance;
}

// Returns the nearest hit that stops the ray.
static inline HitRecord trace_stopped(const AlphaScene* scene, RayRecord ray) {
  for (;;) {
    const HitRecord hit = trace_closest(&scene->tree, ray);
    if (hit.slot == CAPLET_NONE || alpha_stops(scene, &ray, &hit)) return hit;
    ray.t_min = hit.t;  // what is nearer has been asked
  }
}

#endif
