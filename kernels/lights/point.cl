// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Point light: the same intensity in every direction.
#ifndef CAPLET_LIGHTS_POINT_CL
#define CAPLET_LIGHTS_POINT_CL

#include "math/vector.cl"

// `data`: position. Direction and squared distance to it; returns what the intensity is multiplied with (1 / distance squared),
// 0 at the light itself, and so near to it that the square of the distance is no normal number.
static inline float point_sample(__global const float* data, float3 p, float3* wi) {
  const float3 away = load3(data) - p;
  const float distance_squared = dot(away, away);
  if (!(distance_squared >= FLT_MIN)) return 0.0f;
  *wi = away / sqrt(distance_squared);
  return 1.0f / distance_squared;
}

#endif
