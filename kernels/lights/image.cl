// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This is an infinite light of an image: it is sampled, and weighted against BSDF sampling.
#ifndef CAPLET_LIGHTS_IMAGE_CL
#define CAPLET_LIGHTS_IMAGE_CL

#include "lights/environment.cl"
#include "lights/light_types.cl"

static inline float4 image_texels(const Spectra* spectra, const Picture* picture,
                                  __global const LightRecord* light, float2 uv, float4 lambda) {
  return environment_radiance(picture, picture_illuminant(spectra, light), uv, lambda) *
         light->scale;
}

static inline int image_light_sample(const Scene* scene, __global const LightRecord* light,
                                     float3 p, float4 lambda, float2 u, LightSample* s) {
  __global const float* data = light_data_of(&scene->lights, light);
  __global const float* m = image_light_from_world(data);
  const Picture picture = picture_of(&scene->lights, image_picture(data));
  float3 d;
  float2 uv;
  s->pdf = environment_sample(&picture, u, &d, &uv);
  if (!(s->pdf > 0.0f)) return 0;
  // A rotation's inverse is its transpose.
  s->wi = normalize(load3(m) * d.x + load3(m + 3) * d.y + load3(m + 6) * d.z);
  s->target = p + s->wi;
  s->radiance = image_texels(&scene->spectra, &picture, light, uv, lambda);
  return 1;
}

static inline float4 image_light_radiance(const Spectra* spectra, const Lights* lights,
                                          __global const LightRecord* light, float3 p, float3 wi,
                                          float4 lambda, float* pdf) {
  (void)p;
  __global const float* data = light_data_of(lights, light);
  const Picture picture = picture_of(lights, image_picture(data));
  const float2 uv =
      environment_locate(&picture, light_turned(image_light_from_world(data), wi), pdf);
  return image_texels(spectra, &picture, light, uv, lambda);
}

#endif
