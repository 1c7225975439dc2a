// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This texture is the probability that a shape stops a ray, 0 to 1.
#ifndef CAPLET_TEXTURES_ALPHA_CL
#define CAPLET_TEXTURES_ALPHA_CL

#include "textures/texture_types.cl"

static inline float4 alpha_texture_at(const TexturePoint* at, __global const float* data,
                                      const float4* values) {
  (void)at;
  return clamp(values[alpha_texture_tex(data)], 0.0f, 1.0f);
}

#endif
