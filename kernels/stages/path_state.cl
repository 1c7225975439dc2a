// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// PathState is what a path carries from one scattering to the next. A stage loads it at its start
// and stores it where the path goes on.
#ifndef CAPLET_STAGES_PATH_STATE_CL
#define CAPLET_STAGES_PATH_STATE_CL

#include "lights/lights.cl"
#include "stages/clip_plane.cl"
#include "stages/cone_share.cl"
#include "stages/outbox.cl"
#include "stages/path.cl"
#include "stages/sort_key.cl"

typedef struct {
  float4 throughput;   // at the four wavelengths
  float4 wavelengths;  // nm
  float last_pdf;      // of the last direction (solid angle)
  float eta_scale;     // the product of the squared indices of all refractions
  uint crossed_light;  // of the primitive that the last direction crossed; CAPLET_NONE: none
  uint depth;          // scatterings so far
  int specular;        // the last one was a delta, so that no light sample could have found its hit
  int inside;          // the last direction leads into a closed solid; told where has_clip
  int crossed;         // so may it, as solids may lie within each other: a surface was crossed
} PathState;

static inline PathState load_path_state(const Stage* g, uint path) {
  const float4 scatter = g->carried.path_scatter[path];
  const uint flags = g->carried.path_flags[path];
  PathState out;
  out.throughput = g->carried.path_throughput[path];
  out.wavelengths = g->carried.path_wavelengths[path];
  out.last_pdf = scatter.x;
  out.eta_scale = scatter.y;
  out.crossed_light = as_uint(scatter.z);
  out.depth = flags >> PATH_DEPTH_SHIFT;
  out.specular = (flags & PATH_SPECULAR) != 0u;
  out.inside = has_clip && (flags & PATH_INSIDE) != 0u;
  out.crossed = has_clip && (flags & PATH_CROSSED) != 0u;
  return out;
}

// Stores the state of a path that goes on from a scattering. Wavelengths change in one place alone
// (keep_hero_wavelength).
static inline void store_path_state(const Stage* g, uint path, const PathState* state) {
  g->carried.path_throughput[path] = state->throughput;
  g->carried.path_scatter[path] =
      (float4)(state->last_pdf, state->eta_scale, as_float(state->crossed_light), 0.0f);
  g->carried.path_flags[path] = (state->depth << PATH_DEPTH_SHIFT) |
                                path_flag(g->view.view, state->specular) |
                                (has_clip && state->inside ? PATH_INSIDE : 0u) |
                                (has_clip && state->crossed ? PATH_CROSSED : 0u);
}

// Return and set the side of the last scattering that light samples saw: normal_bits, or
// CAPLET_NONE for all sides. Scenes without a light tree have no such state.
static inline uint path_side(const Stage* g, uint path) {
#ifdef CAPLET_LIGHT_TREE
  return g->carried.path_normal[path];
#else
  (void)g, (void)path;
  return CAPLET_NONE;
#endif
}
static inline void set_path_side(const Stage* g, uint path, uint side) {
#ifdef CAPLET_LIGHT_TREE
  g->carried.path_normal[path] = side;
#else
  (void)g, (void)path, (void)side;
#endif
}

// Puts the path, whose next ray is in path_ray, into the queue of the next round. `from`: about
// where the ray begins.
static inline void append_path(const Stage* g, Outbox* out, uint path, float3 from,
                               float3 direction) {
  const uint bits = g->batch.batch->sort_bits;
  append_next(g, out, path,
              bits != CAPLET_NONE ? sort_key(g->tree.world, bits, from, direction) : 0u);
}

// Sends the path on by a ray from `origin`, after a scattering that made `state`.
static inline void continue_path(const Stage* g, Outbox* out, uint path, const PathState* state,
                                 uint side, float3 origin, float3 direction) {
  RayRecord ray = path_onward(origin, direction);
  if (has_clip) clip_onward(g->view.view, &ray);
  g->rays.path_ray[path] = ray;
  store_path_state(g, path, state);
  set_path_side(g, path, side);
  append_path(g, out, path, origin, direction);
}

// Returns whether a scattering takes a light sample.
static inline int takes_light_sample(const Stage* g) {
  return g->lights.lighting->sampled_light_count > 0u &&
         (g->view.view->strategy & CAPLET_STRATEGY_NO_LIGHTS) == 0u;
}

// Sends the shadow ray of a light sample, from `origin`. `contribution` counts where it is free.
// inside: it leads into a closed solid.
static inline void send_shadow_ray(const Stage* g, Outbox* out, uint path, const LightSample* light,
                                   float3 origin, float4 contribution, int inside) {
  ShadowTarget target;
  RayRecord ray = shadow_ray(light, origin, &target);
  if (has_clip) {
    const float t_max = ray.t_max;
    clip_onward(g->view.view, &ray);
    // The light is cut away, or the face that closes the solid is before it.
    if (ray.t_max < t_max && (target.slot != CAPLET_NONE || inside)) return;
  }
  g->shadows.path_shadow[path] = ray;
  g->shadows.path_shadow_target[path] = target;
  g->shadows.path_shadow_radiance[path] = contribution;
  append_shadow(g, out, path);
}

#endif
