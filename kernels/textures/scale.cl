// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This texture is a texture times one of floats.
#ifndef CAPLET_TEXTURES_SCALE_CL
#define CAPLET_TEXTURES_SCALE_CL

#include "textures/texture_types.cl"

static inline float4 scale_texture_at(const TexturePoint* at, __global const float* data,
                                      const float4* values) {
  (void)at;
  return values[scale_texture_tex(data)] * values[scale_texture_scale(data)].x;
}

#endif
