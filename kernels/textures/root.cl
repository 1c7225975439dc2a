// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This texture is the square root of a texture, 0 where that is negative.
#ifndef CAPLET_TEXTURES_ROOT_CL
#define CAPLET_TEXTURES_ROOT_CL

#include "textures/texture_types.cl"

static inline float4 root_texture_at(const TexturePoint* at, __global const float* data,
                                     const float4* values) {
  (void)at;
  return sqrt(fmax(values[root_texture_tex(data)], 0.0f));
}

#endif
