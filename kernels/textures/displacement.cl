// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This texture is how far a surface is moved along its normal. Where a material has one, only its
// effect on the normal is rendered (bsdf/bump.cl).
#ifndef CAPLET_TEXTURES_DISPLACEMENT_CL
#define CAPLET_TEXTURES_DISPLACEMENT_CL

#include "textures/texture_types.cl"

static inline float4 displacement_texture_at(const TexturePoint* at, __global const float* data,
                                             const float4* values) {
  (void)at;
  return values[displacement_texture_tex(data)];
}

#endif
