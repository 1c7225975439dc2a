// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This texture has one value everywhere.
#ifndef CAPLET_TEXTURES_CONSTANT_CL
#define CAPLET_TEXTURES_CONSTANT_CL

#include "textures/texture_types.cl"

static inline float4 constant_texture_at(const TexturePoint* at, __global const float* data,
                                         const float4* values) {
  (void)values;
  return spectrum_eval(at->spectra, constant_texture_value(data), at->lambda);
}

#endif
