// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// All lights: choice of one by the alias table (Walker 1977, Vose 1991), sampling of it, and the densities that multiple
// importance sampling needs. The only switch over kinds of light.
#ifndef CAPLET_LIGHTS_LIGHTS_CL
#define CAPLET_LIGHTS_LIGHTS_CL

#include "groups.cl"
#include "lights/area.cl"
#include "lights/distant.cl"
#include "lights/infinite.cl"
#include "lights/point.cl"
#include "lights/spot.cl"
#include "math/spectrum.cl"
#include "math/vector.cl"
#include "shapes/surface.cl"

// wi: unit, to the light. target: end of the shadow ray of a finite light, off the light's own surface. radiance: that arrives
// along wi unoccluded (delta lights: irradiance over cos). pdf: of wi by solid angle times the chance of the light; for delta
// lights that chance alone. index: of the light.
typedef struct {
  float3 wi, target;
  int infinite, delta;
  uint index;
  float4 radiance;
  float pdf;
} LightSample;

// A light with its chance of being chosen by the random number u. In whole numbers: row u n >> 32 of n, and the rest of u n
// within it, so that the chance is exactly the share of the 2^32 numbers that choose the light (host/lower/detail/light_table.h).
static inline uint light_select(const Lights* lights, uint u, float* probability) {
  const uint count = lights->lighting->light_count;
  const uint i = mul_hi(u, count);
  __global const AliasRecord* row = lights->light_alias + i;
  const uint chosen = u * count < row->keep ? i : row->alias;
  *probability = lights->light_alias[chosen].probability;
  return chosen;
}

// One light sample as seen from p (world). u_select: 32 random bits; u in [0, 1). Returns 0 when there is nothing (the sample counts as black).
static inline int light_sample(const Scene* scene, float3 p, float4 lambda, uint u_select, float2 u, LightSample* s) {
  const Lights* lights = &scene->lights;
  if (lights->lighting->sampled_light_count == 0u) return 0;
  float chance;
  s->index = light_select(lights, u_select, &chance);
  __global const LightRecord* light = lights->lights + s->index;
  if (!(chance > 0.0f)) return 0;
  s->infinite = 0;
  s->delta = 1;
  s->pdf = chance;
  float weight = 1.0f;
  const uint data = light->data;
  switch (light->kind) {
    case light_area: {
      AreaSample point;
      if (!area_sample(scene, light, p, u, &point)) return 0;
      const float3 away = point.p - p;
      s->wi = unit_or(away, (float3)(0.0f));
      if (!(dot(s->wi, s->wi) > 0.0f)) return 0;  // p is the point
      s->target = offset_origin(point.p, point.n, point.error, -s->wi);
      if (!(norm1(s->target) < INFINITY)) return 0;  // the light's error bound is beyond floats
      s->delta = 0;
      s->pdf = chance * point.pdf;
      break;
    }
    case light_point:
      weight = point_sample(lights->light_data + data, p, &s->wi);
      s->target = load3(lights->light_data + data);
      break;
    case light_spot:
      weight = spot_sample(lights->light_data + data, p, &s->wi);
      s->target = load3(lights->light_data + data);
      break;
    case light_distant:
      weight = distant_sample(lights->light_data + data, &s->wi);
      s->target = p + s->wi;
      s->infinite = 1;
      break;
    case light_image:
      s->pdf = chance * image_sample(&scene->spectra, lights, light, lambda, u, &s->wi, &s->radiance);
      s->target = p + s->wi;
      s->infinite = 1;
      s->delta = 0;
      return s->pdf > 0.0f;
    default:
      return 0;
  }
  if (!(weight > 0.0f)) return 0;
  s->radiance = spectrum_eval(&scene->spectra, light->spectrum, lambda) * (light->scale * weight);
  return 1;
}

// Radiance of area light `light` at a point with normal ng (Surface.ng) towards wo; 0 from the dark side.
static inline float4 light_emitted(const Spectra* spectra, const Lights* lights, uint light, float3 ng, float3 wo, float4 lambda) {
  __global const LightRecord* record = lights->lights + light;
  if (!(record->flags & CAPLET_LIGHT_BOTH_SIDES) && !(dot(ng, wo) > 0.0f)) return (float4)(0.0f);
  return spectrum_eval(spectra, record->spectrum, lambda) * record->scale;
}

// Density (solid angle times chance of the light) that light_sample(p) has for the unit direction wi, which meets area light
// `light` at `hit`.
static inline float light_area_pdf(const Scene* scene, uint light, float3 p, const Surface* hit, float3 wi) {
  if (scene->lights.lighting->sampled_light_count == 0u) return 0.0f;
  return scene->lights.light_alias[light].probability * area_pdf(scene, scene->lights.lights + light, p, hit->p, hit->ng, wi);
}

#endif
