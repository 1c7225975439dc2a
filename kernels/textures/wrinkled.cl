// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This texture is a sum of octaves of the magnitude of noise in space.
#ifndef CAPLET_TEXTURES_WRINKLED_CL
#define CAPLET_TEXTURES_WRINKLED_CL

#include "textures/noise.cl"

static inline float4 wrinkled_texture_at(const TexturePoint* at, __global const float* data,
                                         const float4* values) {
  (void)values;
  return (float4)(noise_turbulence(texture_xyz(at, wrinkled_texture_place(data)),
                                   wrinkled_texture_roughness(data),
                                   wrinkled_texture_octaves(data)));
}

#endif
