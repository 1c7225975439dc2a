// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This is an infinite light of one radiance, which only BSDF sampling finds.
#ifndef CAPLET_LIGHTS_CONSTANT_CL
#define CAPLET_LIGHTS_CONSTANT_CL

#include "lights/light_types.cl"

static inline float4 constant_light_radiance(const Spectra* spectra, const Lights* lights,
                                             __global const LightRecord* light, float3 p, float3 wi,
                                             float4 lambda, float* pdf) {
  (void)lights, (void)p, (void)wi, (void)pdf;
  return spectrum_eval(spectra, light->spectrum, lambda) * light->scale;
}

#endif
