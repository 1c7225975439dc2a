// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// What the lights share.
#ifndef CAPLET_LIGHTS_LIGHT_TYPES_CL
#define CAPLET_LIGHTS_LIGHT_TYPES_CL

#include "groups.cl"
#include "math/spectrum.cl"
#include "math/vector.cl"
#include "shapes/surface.cl"
#include "shared/families.h"

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

static inline __global const float* light_data_of(const Lights* lights, __global const LightRecord* light) {
  return lights->light_data + light->data;
}

// The light's own spectrum.
static inline float4 light_spectrum(const Spectra* spectra, __global const LightRecord* light, float4 lambda, float weight) {
  return spectrum_eval(spectra, light->spectrum, lambda) * (light->scale * weight);
}

#endif
