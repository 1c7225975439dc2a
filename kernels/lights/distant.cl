// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// A distant light has one direction and the same irradiance (square to it) everywhere.
#ifndef CAPLET_LIGHTS_DISTANT_CL
#define CAPLET_LIGHTS_DISTANT_CL

#include "lights/light_types.cl"

static inline int distant_light_sample(const Scene* scene, __global const LightRecord* light,
                                       float3 p, float4 lambda, float2 u, LightSample* s) {
  (void)u;
  s->wi = load3(distant_direction(light_data_of(&scene->lights, light)));
  s->target = p + s->wi;
  s->pdf = 1.0f;
  s->radiance = light_spectrum(&scene->spectra, light, lambda, 1.0f);
  return 1;
}

#endif
