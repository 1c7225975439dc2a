// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// An infinite light of an image: sampled, and weighted against BSDF sampling.
#ifndef CAPLET_LIGHTS_IMAGE_CL
#define CAPLET_LIGHTS_IMAGE_CL

#include "lights/environment.cl"
#include "lights/light_types.cl"

static inline float4 image_texels(const Spectra* spectra, const Lights* lights, __global const LightRecord* light, float2 uv, float4 lambda) {
  return environment_radiance(lights, spectra->spectrum_tables + spectra->spectra[light->spectrum].table, uv, lambda) * light->scale;
}

static inline int image_light_sample(const Scene* scene, __global const LightRecord* light, float3 p, float4 lambda, float2 u, LightSample* s) {
  const Lights* lights = &scene->lights;
  __global const float* m = image_light_from_world(light_data_of(lights, light));
  float3 d;
  float2 uv;
  s->pdf = environment_sample(lights, u, &d, &uv);
  if (!(s->pdf > 0.0f)) return 0;
  // A rotation's inverse is its transpose.
  s->wi = normalize(load3(m) * d.x + load3(m + 3) * d.y + load3(m + 6) * d.z);
  s->target = p + s->wi;
  s->radiance = image_texels(&scene->spectra, lights, light, uv, lambda);
  return 1;
}

static inline float4 image_light_radiance(const Spectra* spectra, const Lights* lights, __global const LightRecord* light, float3 wi,
                                          float4 lambda, float* pdf) {
  __global const float* m = image_light_from_world(light_data_of(lights, light));
  const float3 d = (float3)(dot(load3(m), wi), dot(load3(m + 3), wi), dot(load3(m + 6), wi));
  const float2 uv = environment_locate(lights, d, pdf);
  return image_texels(spectra, lights, light, uv, lambda);
}

#endif
