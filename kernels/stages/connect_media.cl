// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Shadow rays among media: what is left of their light when they reach it.
#include "media/immersion.cl"
#include "media/travel.cl"
#include "stages/path.cl"
#include "trace/alpha.cl"

// Whether light goes through the surface of a hit as if it were not there.
static inline int surface_passes(const Stage* g, const HitRecord* hit) {
  const uint primitive = as_uint(g->tree.leaves[hit->slot]);
  __global const GeometryRecord* geometry = g->surfaces.geometries + g->surfaces.primitive_geometry[primitive];
  uint material = geometry->material;
  if (geometry->surface_begin != CAPLET_NONE)
    material = g->surfaces.surface_materials[geometry->surface_begin + (hit->surface & CAPLET_SURFACE_MASK)] & ~CAPLET_SURFACE_DARK;
  switch (g->materials.materials[material].kind) {
#define MATERIAL(name, traits) \
  case material_##name: return ((traits)&trait_passes) != 0;
#define CHOICE(name, traits)
#include "rows/materials.def"
#undef MATERIAL
    default: return 0;
  }
}

static void stage_item(const Stage* g, uint item) {
  const AlphaScene scene = {g->tree, g->surfaces, g->spectra, g->materials};
  const uint path = g->shadows.queue_shadow[item];
  RayRecord ray = g->shadows.path_shadow[path];
  Held held = {g->immersion.shadow_inside[path], g->immersion.shadow_around[path]};
  const float2 pdfs = g->immersion.shadow_pdfs[path];
  const float4 wavelengths = g->carried.path_wavelengths[path];
  const float3 o = (float3)(ray.ox, ray.oy, ray.oz), d = (float3)(ray.dx, ray.dy, ray.dz);
  const PathSample at = path_sample(g->batch.batch, g->view.view->seed, path);
  MediumNumbers numbers = {hash_combine(path_hash(at, g->carried.path_flags[path]), 0x5bd1e995u), 0u};
  MediumWeights weights;
  weights.throughput = g->shadows.path_shadow_radiance[path];
  weights.scattering = weights.light = g->immersion.path_ratio[path];
  weights.most = max4(fabs(weights.throughput));
  for (;;) {
    const HitRecord hit = trace_closest(&g->tree, ray);
    const int met = hit.slot != CAPLET_NONE;
    const int crosses = met && alpha_stops(&scene, &ray, &hit);
    if (crosses && !surface_passes(g, &hit)) return;
    const Held here = held_before(&g->tree, &g->surfaces, &g->media, &hit, isinf(ray.t_max), held);
    const uint medium = held_medium(&g->media, &here);
    if (medium != CAPLET_NONE && !medium_dims(&g->media, &g->spectra, medium, wavelengths, o, d, ray.t_min, met ? hit.t : ray.t_max, &numbers, &weights))
      return;
    if (!met) break;
    held = here;
    if (crosses) held_cross(&g->tree, &g->surfaces, &g->media, &hit, &held);
    ray.t_min = hit.t;
  }
  const float light = mean4(weights.light), scattering = mean4(weights.scattering);
  if (!(light > 0.0f)) return;
  const float weight = pdfs.y > 0.0f ? power_heuristic(pdfs.x * light, pdfs.y * scattering) : 1.0f;
  g->radiance.path_radiance[path] += weights.throughput * (weight / light);
}
