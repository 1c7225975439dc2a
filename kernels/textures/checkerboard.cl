// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Squares of uv, point sampled: the first texture where the sum of their numbers is even (pbrt-v4).
#ifndef CAPLET_TEXTURES_CHECKERBOARD_CL
#define CAPLET_TEXTURES_CHECKERBOARD_CL

#include "textures/texture_types.cl"

static inline float4 checkerboard_texture_at(const TexturePoint* at, __global const float* data, const float4* values) {
  const float s = floor(checkerboard_texture_uscale(data) * at->uv.x + checkerboard_texture_udelta(data));
  const float t = floor(checkerboard_texture_vscale(data) * at->uv.y + checkerboard_texture_vdelta(data));
  // Whole numbers as floats: their halves tell odd from even at any size.
  const int odd = (s * 0.5f != floor(s * 0.5f)) != (t * 0.5f != floor(t * 0.5f));
  return values[odd ? checkerboard_texture_tex2(data) : checkerboard_texture_tex1(data)];
}

#endif
