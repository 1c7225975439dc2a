// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This texture mixes two textures by one of floats.
#ifndef CAPLET_TEXTURES_MIX_CL
#define CAPLET_TEXTURES_MIX_CL

#include "textures/texture_types.cl"

static inline float4 mix_texture_at(const TexturePoint* at, __global const float* data,
                                    const float4* values) {
  (void)at;
  const float amount = values[mix_texture_amount(data)].x;
  return (1.0f - amount) * values[mix_texture_tex1(data)] + amount * values[mix_texture_tex2(data)];
}

#endif
