// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This texture mixes two textures by the angle of the surface: the first where its normal is along
// a direction, the second across it.
#ifndef CAPLET_TEXTURES_DIRECTIONMIX_CL
#define CAPLET_TEXTURES_DIRECTIONMIX_CL

#include "textures/texture_types.cl"

static inline float4 directionmix_texture_at(const TexturePoint* at, __global const float* data,
                                             const float4* values) {
  const float amount =
      clamp(fabs(dot(at->place.n, load3(directionmix_texture_dir(data)))), 0.0f, 1.0f);
  return amount * values[directionmix_texture_tex1(data)] +
         (1.0f - amount) * values[directionmix_texture_tex2(data)];
}

#endif
