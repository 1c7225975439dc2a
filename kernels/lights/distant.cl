// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Distant light: one direction, the same irradiance (square to it) everywhere.
#ifndef CAPLET_LIGHTS_DISTANT_CL
#define CAPLET_LIGHTS_DISTANT_CL

#include "math/vector.cl"

// `data`: unit direction to the light. Returns what the irradiance is multiplied with.
static inline float distant_sample(__global const float* data, float3* wi) {
  *wi = load3(data);
  return 1.0f;
}

#endif
