// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Computes the emission of hot media.
#ifndef CAPLET_MEDIA_BLACKBODY_CL
#define CAPLET_MEDIA_BLACKBODY_CL

// Returns Planck's law over its greatest value at that temperature (kelvin), which is at hc /
// (lambda k T) = 4.965114. Below 100 K it is 0, as in pbrt-v4.
static inline float4 blackbody_at(float kelvin, float4 lambda) {
  if (!(kelvin > 100.0f)) return (float4)(0.0f);
  const float4 x = 1.438776877e7f / (lambda * kelvin);
  const float4 part = x * (1.0f / 4.965114232f), square = part * part;
  return part * square * square * (142.324916f / (exp(fmin(x, 80.0f)) - 1.0f));
}

#endif
