// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This texture is bilinear between values at the corners of the unit square, and extrapolates
// beyond it.
#ifndef CAPLET_TEXTURES_BILERP_CL
#define CAPLET_TEXTURES_BILERP_CL

#include "textures/mapping.cl"

static inline float4 bilerp_texture_at(const TexturePoint* at, __global const float* data,
                                       const float4* values) {
  const TextureST c = texture_st(at, bilerp_texture_mapping(data));
  const float s = c.st.x, t = c.st.y;
  return (1.0f - s) * ((1.0f - t) * values[bilerp_texture_v00(data)] +
                       t * values[bilerp_texture_v01(data)]) +
         s * ((1.0f - t) * values[bilerp_texture_v10(data)] + t * values[bilerp_texture_v11(data)]);
}

#endif
