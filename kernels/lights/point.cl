// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// A point light has the same intensity in every direction.
#ifndef CAPLET_LIGHTS_POINT_CL
#define CAPLET_LIGHTS_POINT_CL

#include "lights/light_types.cl"

// Computes the direction to a point. Returns the factor on the intensity there (1 / distance
// squared). It is 0 at the point itself, and so near to it that the square of the distance is no
// normal number.
static inline float point_weight(float3 position, float3 p, float3* wi) {
  const float3 away = position - p;
  const float distance_squared = dot(away, away);
  if (!(distance_squared >= FLT_MIN)) return 0.0f;
  *wi = away / sqrt(distance_squared);
  return 1.0f / distance_squared;
}

// Point lights whose intensity depends on the direction share this: it fills where they are and wi,
// and in *w the direction of the light that goes to p, in the light's own space. Returns
// point_weight.
static inline float lamp_weight(__global const float* position,
                                __global const float* light_from_world, float3 p, float3* w,
                                LightSample* s) {
  s->target = load3(position);
  s->pdf = 1.0f;
  const float weight = point_weight(s->target, p, &s->wi);
  if (!(weight > 0.0f)) return 0.0f;
  *w = light_turned(light_from_world, -s->wi);
  return weight;
}
// Multiplies the light's spectrum, by that weight, with its intensity along w. Returns 0 if there
// is none.
static inline int lamp_shines(const Scene* scene, __global const LightRecord* light, float4 lambda,
                              float weight, LightSample* s) {
  if (!(weight > 0.0f)) return 0;
  s->radiance = light_spectrum(&scene->spectra, light, lambda, weight);
  return 1;
}

static inline int point_light_sample(const Scene* scene, __global const LightRecord* light,
                                     float3 p, float4 lambda, float2 u, LightSample* s) {
  (void)u;
  s->target = load3(point_position(light_data_of(&scene->lights, light)));
  s->pdf = 1.0f;
  return lamp_shines(scene, light, lambda, point_weight(s->target, p, &s->wi), s);
}

#endif
