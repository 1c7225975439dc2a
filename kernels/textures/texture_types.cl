// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This file holds what the textures share.
#ifndef CAPLET_TEXTURES_TEXTURE_TYPES_CL
#define CAPLET_TEXTURES_TEXTURE_TYPES_CL

#include "groups.cl"
#include "math/spectrum.cl"
#include "math/vector.cl"
#include "shared/families.h"

// TexturePlace is a point of a surface, in the world, and its footprint: a parallelogram, by its
// sides.
typedef struct {
  float2 uv;
  float3 p, n;          // n: geometric normal, unit
  float3 dpdx, dpdy;    // the sides
  float2 duvdx, duvdy;  // along them
} TexturePlace;

// Images and checkerboards are means over this many times the sides of a place, about what
// pbrt-v4's filters of them take in; noise is filtered by the sides as they are.
#define CAPLET_FILTER_SIDES 2.0f

// TexturePoint is a place at four wavelengths (nm).
typedef struct {
  const Materials* materials;
  const Spectra* spectra;
  TexturePlace place;
  float4 lambda;
} TexturePoint;

// Returns the point with coordinates uv of a surface in the plane z = 0.
static inline TexturePlace texture_place(float2 uv) {
  const TexturePlace place = {uv,
                              (float3)(uv.x, uv.y, 0.0f),
                              (float3)(0.0f, 0.0f, 1.0f),
                              (float3)(0.0f),
                              (float3)(0.0f),
                              (float2)(0.0f),
                              (float2)(0.0f)};
  return place;
}

#endif
