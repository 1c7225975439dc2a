// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Computes k of a metal of index 1 from a texture of its reflectance r at normal incidence: r = k^2
// / (4 + k^2); r at most 0.9999 (pbrt-v4).
#ifndef CAPLET_TEXTURES_EXTINCTION_CL
#define CAPLET_TEXTURES_EXTINCTION_CL

#include "textures/texture_types.cl"

static inline float4 extinction_texture_at(const TexturePoint* at, __global const float* data,
                                           const float4* values) {
  (void)at;
  const float4 r = clamp(values[extinction_texture_tex(data)], 0.0f, 0.9999f);
  return 2.0f * sqrt(r) / sqrt(1.0f - r);
}

#endif
