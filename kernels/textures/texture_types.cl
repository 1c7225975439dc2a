// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// What the textures share.
#ifndef CAPLET_TEXTURES_TEXTURE_TYPES_CL
#define CAPLET_TEXTURES_TEXTURE_TYPES_CL

#include "groups.cl"
#include "math/spectrum.cl"
#include "math/vector.cl"
#include "shared/families.h"

// A point of a surface, seen at four wavelengths (nm).
typedef struct {
  const Spectra* spectra;
  float2 uv;
  float4 lambda;
} TexturePoint;

#endif
