// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This file holds what the lights share.
#ifndef CAPLET_LIGHTS_LIGHT_TYPES_CL
#define CAPLET_LIGHTS_LIGHT_TYPES_CL

#include "groups.cl"
#include "math/spectrum.cl"
#include "math/vector.cl"
#include "shapes/surface.cl"
#include "shared/families.h"

// wi: unit, to the light. target: the sampled point of a finite light. slack: a shadow ray meets
// the light's surface within this length of target, along the ray; 0: the light is no surface.
// slot, instance: the primitive that the shadow ray must meet first; CAPLET_NONE: none, the ray
// ends before target. radiance: that arrives along wi unoccluded (delta lights: irradiance over
// cos). pdf: of wi by solid angle times the chance of the light; for delta lights that chance
// alone. index: of the light.
typedef struct {
  float3 wi, target;
  float slack;
  uint slot, instance;
  int infinite, delta;
  uint index;
  float4 radiance;
  float pdf;
} LightSample;

// Returns the ray from `origin` to the sampled point. It ends where it has met the light's surface
// or, where there is none to meet, before the point.
static inline RayRecord shadow_ray(const LightSample* s, float3 origin, ShadowTarget* target) {
  float3 d = s->wi;
  float distance = INFINITY;
  if (!s->infinite) {
    const float3 away = s->target - origin;
    distance = sqrt(dot(away, away));
    d = away / distance;
  }
  const int surface = s->slot != CAPLET_NONE;
  target->slot = s->slot;
  target->instance = s->instance;
  target->enough = surface ? distance - s->slack : INFINITY;
  target->pad0 = 0u;
  RayRecord ray;
  ray.ox = origin.x;
  ray.oy = origin.y;
  ray.oz = origin.z;
  ray.t_min = 0.0f;
  ray.dx = d.x;
  ray.dy = d.y;
  ray.dz = d.z;
  ray.t_max = surface ? distance + s->slack : distance - s->slack;
  return ray;
}

static inline __global const float* light_data_of(const Lights* lights,
                                                  __global const LightRecord* light) {
  return lights->light_data + light->data;
}

// Picture is an image of a light (lights.def).
typedef struct {
  Floats texels, cdf;
  uint width, height, square;
} Picture;

static inline Picture picture_of(const Lights* lights, __global const float* field) {
  const Picture picture = {floats_from(light_texels_of(lights), as_uint(field[0])),
                           floats_from(light_cdf_of(lights), as_uint(field[1])), as_uint(field[2]),
                           as_uint(field[3]), as_uint(field[4])};
  return picture;
}

// Returns the four numbers of texel `i` (lights.def).
static inline float4 picture_texel(const Picture* picture, size_t i) {
  return vload4(0, floats_at(picture->texels, 4 * i));
}

// Returns the number of the texel that holds uv, which are within 0 and 1.
static inline size_t picture_nearest(const Picture* picture, float2 uv) {
  const uint x = min((uint)(uv.x * (float)picture->width), picture->width - 1u),
             y = min((uint)(uv.y * (float)picture->height), picture->height - 1u);
  return (size_t)y * picture->width + x;
}

// Returns the table of the illuminant for the colours of a light's picture.
static inline __global const float* picture_illuminant(const Spectra* spectra,
                                                       __global const LightRecord* light) {
  return spectra->spectrum_tables + spectra->spectra[light->spectrum].table;
}

// Returns v under a turn (lights.def).
static inline float3 light_turned(__global const float* turn, float3 v) {
  return (float3)(dot(load3(turn), v), dot(load3(turn + 3), v), dot(load3(turn + 6), v));
}

// Returns the light's own spectrum.
static inline float4 light_spectrum(const Spectra* spectra, __global const LightRecord* light,
                                    float4 lambda, float weight) {
  return spectrum_eval(spectra, light->spectrum, lambda) * (light->scale * weight);
}

#endif
