// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This file dispatches to all textures. A texture of textures.def has a file in this folder with
// its name, which defines
//   float4 NAME_texture_at(at, data, values)
// It returns the value at the four wavelengths; that of a texture of floats is component 0. values:
// those of the steps before, by the numbers that the fields of type texture hold.
#ifndef CAPLET_TEXTURES_TEXTURES_CL
#define CAPLET_TEXTURES_TEXTURES_CL

#include "textures/texture_types.cl"
#include "textures/{textures}.cl"

enum {
  // any_texture says whether the program has any.
  any_texture = 0
#define TEXTURE(name) || 1
#include "rows/textures.def"
#undef TEXTURE
};

// Evaluates the texture whose first step is number `first`: its steps in order, the last of which
// is its value.
static inline float4 texture_eval(uint first, const TexturePoint* at) {
  const Materials* materials = at->materials;
  float4 values[CAPLET_TEXTURE_MAX_STEPS];
  values[0] = (float4)(0.0f);
  const uint steps = materials->textures[first].steps;
  for (uint i = 0; i < steps; ++i) {
    __global const TextureRecord* step = materials->textures + first + i;
    __global const float* data = materials->texture_data + step->data;
    (void)data;
    switch (step->kind) {
#define TEXTURE(name)                                \
  case texture_##name:                               \
    values[i] = name##_texture_at(at, data, values); \
    break;
#include "rows/textures.def"
#undef TEXTURE
      default: values[i] = (float4)(0.0f); break;
    }
  }
  return values[steps - 1];
}

// Returns the probability, 0 to 1, that a surface stops a ray at a point: that of the texture with
// the first step `alpha`. n: geometric normal, unit.
static inline float alpha_chance(const Materials* materials, const Spectra* spectra, uint alpha,
                                 float2 uv, float3 p, float3 n) {
  TexturePoint at = {materials, spectra, texture_place(uv), (float4)(550.0f)};
  at.place.p = p;
  at.place.n = n;
  return texture_eval(alpha, &at).x;
}

#endif
