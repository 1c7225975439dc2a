// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This file chooses a light, by the alias table (Walker 1977, Vose 1991) or, where there are many
// lights, by the light tree (tree.cl); it samples that light, and computes the densities for
// multiple importance sampling. It holds the only switches over kinds of light.
//
// A light of lights.def has a file in this folder with its name, which defines
//   int NAME_light_sample(scene, light, p, lambda, u, s)
//       as light_sample: fills wi, target, radiance and pdf (of wi alone; delta lights: 1). Is not
//       called for a glow
//   float NAME_light_pdf(scene, light, p, hit, wi)
//       surface: its density for wi, which meets the light at `hit`
//   float4 NAME_light_emitted(spectra, lights, light, uv, lambda)
//       surface: its radiance at uv, on a side that emits
//   float4 NAME_light_radiance(spectra, lights, light, p, wi, lambda, pdf)
//       sky, glow: the radiance that comes to p from direction wi, and the density for it (sky)
#ifndef CAPLET_LIGHTS_LIGHTS_CL
#define CAPLET_LIGHTS_LIGHTS_CL

#include "lights/light_types.cl"
#include "lights/tree.cl"
#include "lights/{lights}.cl"

enum {
  // This constant says whether some light of the program may be a surface.
  any_surface_light = 0
#define LIGHT_MAY_BE_surface || 1
#define LIGHT_MAY_BE_delta
#define LIGHT_MAY_BE_far_delta
#define LIGHT_MAY_BE_sky
#define LIGHT_MAY_BE_glow
#define LIGHT(name, way) LIGHT_MAY_BE_##way
#include "rows/lights.def"
#undef LIGHT
};

// Returns the first light of the table. With a tree, emissive primitives are not in the table.
static inline uint light_table_begin(const Lights* lights) {
#ifdef CAPLET_LIGHT_TREE
  return lights->lighting->table_begin;
#else
  (void)lights;
  return 0u;
#endif
}

// Returns a light that the random number u chooses, and its probability. The choice is in whole
// numbers: row u n >> 32 of n, and the rest of u n within it, so that the probability is exactly
// the share of the 2^32 numbers that choose the light (host/lower/detail/light_table.h).
static inline uint light_select(const Lights* lights, uint u, float* probability) {
  const uint begin = light_table_begin(lights), count = lights->lighting->light_count - begin;
  const uint i = mul_hi(u, count);
  __global const AliasRecord* row = lights->light_alias + i;
  const uint chosen = u * count < row->keep ? i : row->alias;
  *probability = lights->light_alias[chosen].probability;
  return begin + chosen;
}

// Chooses one of all lights for the receiver `at`, and its probability; CAPLET_NONE: none. u: 32
// random bits.
static inline uint light_choose(const Lights* lights, const LightReceiver* at, uint u,
                                float* chance) {
#ifdef CAPLET_LIGHT_TREE
  const uint share = lights->lighting->tree_share;
  if (u < share || share == CAPLET_NONE) {
    const uint light =
        light_of_tree(lights, at, fmin((float)u / (float)share, 0x1.fffffep-1f), u, chance);
    *chance *= (float)share * 0x1p-32f;
    return light;
  }
  const uint rest = 0u - share;  // of 2^32
  const uint light = light_select(lights, (uint)(((ulong)(u - share) << 32) / rest), chance);
  *chance *= (float)rest * 0x1p-32f;
  return light;
#else
  (void)at;
  return light_select(lights, u, chance);
#endif
}

// Returns the probability of `light` in light_choose.
static inline float light_chance(const Lights* lights, uint light, const LightReceiver* at) {
#ifdef CAPLET_LIGHT_TREE
  const uint share = lights->lighting->tree_share;
  if (lights->light_places[light] != CAPLET_NONE)
    return (float)share * 0x1p-32f * light_tree_chance(lights, light, at);
  const uint begin = light_table_begin(lights);
  if (share == CAPLET_NONE || light < begin) return 0.0f;
  return (float)(0u - share) * 0x1p-32f * lights->light_alias[light - begin].probability;
#else
  (void)at;
  return lights->light_alias[light].probability;
#endif
}

#define SAMPLE_LIGHT_OF(name, is_infinite, is_delta)                   \
  case light_##name:                                                   \
    s->infinite = is_infinite;                                         \
    s->delta = is_delta;                                               \
    if (!name##_light_sample(scene, light, p, lambda, u, s)) return 0; \
    break;
#define SAMPLE_LIGHT_surface(name) SAMPLE_LIGHT_OF(name, 0, 0)
#define SAMPLE_LIGHT_delta(name) SAMPLE_LIGHT_OF(name, 0, 1)
#define SAMPLE_LIGHT_far_delta(name) SAMPLE_LIGHT_OF(name, 1, 1)
#define SAMPLE_LIGHT_sky(name) SAMPLE_LIGHT_OF(name, 1, 0)
#define SAMPLE_LIGHT_glow(name)

// Takes one light sample as seen from at.p. u_select: 32 random bits; u in [0, 1). Returns 0 when
// there is nothing (the sample counts as black).
static inline int light_sample(const Scene* scene, LightReceiver at, float4 lambda, uint u_select,
                               float2 u, LightSample* s) {
  const Lights* lights = &scene->lights;
  if (lights->lighting->sampled_light_count == 0u) return 0;
  const float3 p = at.p;
  float chance;
  s->index = light_choose(lights, &at, u_select, &chance);
  s->slot = s->instance = CAPLET_NONE;
  s->slack = 0.0f;
  if (s->index == CAPLET_NONE || !(chance > 0.0f)) return 0;
  __global const LightRecord* light = lights->lights + s->index;
  switch (light->kind) {
#define LIGHT(name, way) SAMPLE_LIGHT_##way(name)
#include "rows/lights.def"
#undef LIGHT
    default: return 0;
  }
  s->pdf *= chance;
  return s->pdf > 0.0f;
}

// Returns the radiance of area light `light` at a point with normal ng (Surface.ng) and uv, towards
// wo; 0 from the dark side.
static inline float4 light_emitted(const Spectra* spectra, const Lights* lights, uint light,
                                   float3 ng, float2 uv, float3 wo, float4 lambda) {
  __global const LightRecord* record = lights->lights + light;
  if (!(record->flags & CAPLET_LIGHT_BOTH_SIDES) && !(dot(ng, wo) > 0.0f)) return (float4)(0.0f);
  switch (record->kind) {
#define LIGHT_EMITTED_surface(name) \
  case light_##name:                \
    return name##_light_emitted(spectra, lights, record, uv, lambda);
#define LIGHT_EMITTED_delta(name)
#define LIGHT_EMITTED_far_delta(name)
#define LIGHT_EMITTED_sky(name)
#define LIGHT_EMITTED_glow(name)
#define LIGHT(name, way) LIGHT_EMITTED_##way(name)
#include "rows/lights.def"
#undef LIGHT
    default: return (float4)(0.0f);
  }
}

// Returns the density (solid angle times probability of the light) of light_sample at `at` for the
// unit direction wi, which meets light `light` at `hit`.
static inline float light_area_pdf(const Scene* scene, uint light, LightReceiver at,
                                   const Surface* hit, float3 wi) {
  if (scene->lights.lighting->sampled_light_count == 0u) return 0.0f;
  __global const LightRecord* record = scene->lights.lights + light;
  const float3 p = at.p;
  const float chance = light_chance(&scene->lights, light, &at);
  switch (record->kind) {
#define LIGHT_PDF_surface(name) \
  case light_##name:            \
    return chance * name##_light_pdf(scene, record, p, hit, wi);
#define LIGHT_PDF_delta(name)
#define LIGHT_PDF_far_delta(name)
#define LIGHT_PDF_sky(name)
#define LIGHT_PDF_glow(name)
#define LIGHT(name, way) LIGHT_PDF_##way(name)
#include "rows/lights.def"
#undef LIGHT
    default: return 0.0f;
  }
}

// Returns the sum over infinite lights of radiance times MIS weight, for a ray from p in direction
// wi (unit) that left the scene. bsdf_pdf: solid-angle density that the ray was made with;
// `specular`: no light sample could have made it (also camera rays).
static inline float4 light_infinite(const Spectra* spectra, const Lights* lights, float3 p,
                                    float3 wi, float4 lambda, float bsdf_pdf, int specular) {
  float4 sum = (float4)(0.0f);
  const LightReceiver anywhere = {(float3)(0.0f), CAPLET_NONE};  // no infinite light is in the tree
  for (uint i = lights->lighting->infinite_begin; i < lights->lighting->light_count; ++i) {
    __global const LightRecord* light = lights->lights + i;
    float pdf = 0.0f;
    switch (light->kind) {
#define LIGHT_MET_surface(name)
#define LIGHT_MET_delta(name)
#define LIGHT_MET_far_delta(name)
#define LIGHT_MET_sky(name)                                                                        \
  case light_##name: {                                                                             \
    const float4 radiance = name##_light_radiance(spectra, lights, light, p, wi, lambda, &pdf);    \
    pdf *= lights->lighting->sampled_light_count > 0u ? light_chance(lights, i, &anywhere) : 0.0f; \
    sum += radiance * (specular ? 1.0f : power_heuristic(bsdf_pdf, pdf));                          \
    break;                                                                                         \
  }
#define LIGHT_MET_glow(name)                                                   \
  case light_##name:                                                           \
    sum += name##_light_radiance(spectra, lights, light, p, wi, lambda, &pdf); \
    break;
#define LIGHT(name, way) LIGHT_MET_##way(name)
#include "rows/lights.def"
#undef LIGHT
      default: break;
    }
  }
  return sum;
}

#endif
