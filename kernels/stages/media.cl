// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This file holds what paths among media carry beside the state of all paths.
#ifndef CAPLET_STAGES_MEDIA_CL
#define CAPLET_STAGES_MEDIA_CL

#include "media/medium_stack.cl"
#include "media/passing.cl"
#include "shapes/surface.cl"
#include "stages/path_state.cl"
#include "stages/within.cl"

static inline MediumStack path_medium_stack(const Stage* g, uint path) {
  const MediumStack stack = {g->medium_stacks.path_inside[path],
                             g->medium_stacks.path_around[path]};
  return stack;
}
static inline void set_path_medium_stack(const Stage* g, uint path, MediumStack stack) {
  g->medium_stacks.path_inside[path] = stack.inside;
  g->medium_stacks.path_around[path] = stack.around;
}
static inline void set_shadow_medium_stack(const Stage* g, uint path, MediumStack stack,
                                           int is_alone) {
  g->medium_stacks.shadow_near[path] = is_alone ? CAPLET_ALONE : CAPLET_RECOUNT;
  g->medium_stacks.shadow_inside[path] = stack.inside;
  g->medium_stacks.shadow_around[path] = stack.around;
}

// Returns the boundaries of a path that goes through its hit. Where other surfaces are at the same
// place, this is only what this surface tells.
static inline MediumStack medium_stack_behind(const Stage* g, uint path, const HitRecord* hit) {
  MediumStack stack = path_medium_stack(g, path);
  medium_stack_cross(&g->tree, &g->surfaces, &g->media, hit, &stack);
  const uint near = g->medium_stacks.path_near[path];
  if (near >= CAPLET_NEAR_LEFT) stack.around = g->media.boundaries[near - CAPLET_NEAR_LEFT].outside;
  return stack;
}
// These are called for a path that goes on from its hit, or through it.
static inline void media_leave_hit(const Stage* g, uint path) {
  if (g->medium_stacks.path_near[path] != CAPLET_ALONE)
    g->medium_stacks.path_near[path] = CAPLET_RECOUNT;
}
static inline void media_crossed(const Stage* g, uint path, const HitRecord* hit) {
  set_path_medium_stack(g, path, medium_stack_behind(g, path, hit));
  media_leave_hit(g, path);
}

// Returns 1 if the path goes on behind a surface that lets light pass unchanged. Its ray keeps its
// origin, so that the densities of lights are those at the last scattering, and its t_min becomes
// the surface's t.
static inline int media_passes(const Stage* g, Outbox* out, uint path, uint material,
                               const RayRecord* ray, const HitRecord* hit) {
  if (!material_passes(&g->materials, material)) return 0;
  media_crossed(g, path, hit);
  g->rays.path_ray[path].t_min = hit->t;
  if (has_clip) g->carried.path_flags[path] &= ~PATH_FROM_PLANE;
  const float3 o = (float3)(ray->ox, ray->oy, ray->oz), d = (float3)(ray->dx, ray->dy, ray->dz);
  append_path(g, out, path, o + hit->t * d, d);
  return 1;
}

// Keeps what connect_media needs of a light sample beside its radiance: the boundaries of its ray,
// and the densities, by which it weights the sample. Returns the weight here, which is 1.
static inline float media_light_weight(const Stage* g, uint path, const HitRecord* hit,
                                       const LightSample* light, int crosses, float bsdf_pdf) {
  set_shadow_medium_stack(g, path,
                          crosses ? medium_stack_behind(g, path, hit) : path_medium_stack(g, path),
                          g->medium_stacks.path_near[path] == CAPLET_ALONE);
  g->medium_stacks.shadow_pdfs[path] = (float2)(light->pdf, light->delta ? 0.0f : bsdf_pdf);
  return 1.0f;
}

// Keeps the hero wavelength alone for a direction that no other wavelength could have made.
static inline void media_hero_alone(const Stage* g, uint path, PathState* state) {
  state->throughput.x /= g->medium_stacks.path_ratio[path].x;
  g->medium_stacks.path_ratio[path] = (float4)(1.0f);
  g->carried.path_wavelengths[path] = (float4)(state->wavelengths.x);
}

// Updates the state for a path that goes on from a scattering at a surface, maybe through it.
static inline void media_scattered(const Stage* g, uint path, const HitRecord* hit, int crosses) {
  g->medium_stacks.path_light_ratio[path] = g->medium_stacks.path_ratio[path];
  if (crosses)
    media_crossed(g, path, hit);
  else
    media_leave_hit(g, path);
}

// Returns the density of the path's last direction for weighting against light samples: media
// weight the wavelengths of light samples by their own.
static inline float media_last_pdf(const Stage* g, uint path, float pdf) {
  return pdf / mean4(g->medium_stacks.path_light_ratio[path]);
}

// Returns how many scatterings of the path do not count towards its depth.
static inline uint media_uncounted(const Stage* g, uint path) {
  return g->medium_stacks.path_within[path];
}

enum { in_media = 1 };

#endif
