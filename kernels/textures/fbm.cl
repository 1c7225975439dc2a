// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This texture is a sum of octaves of noise in space.
#ifndef CAPLET_TEXTURES_FBM_CL
#define CAPLET_TEXTURES_FBM_CL

#include "textures/noise.cl"

static inline float4 fbm_texture_at(const TexturePoint* at, __global const float* data,
                                    const float4* values) {
  (void)values;
  return (float4)(noise_fbm(texture_xyz(at, fbm_texture_place(data)), fbm_texture_roughness(data),
                            fbm_texture_octaves(data)));
}

#endif
