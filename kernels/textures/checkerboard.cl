// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This texture has squares, or cubes, of unit size: the first texture where the sum of their
// numbers is even. A footprint over several of them takes their mean over a box, in closed form.
#ifndef CAPLET_TEXTURES_CHECKERBOARD_CL
#define CAPLET_TEXTURES_CHECKERBOARD_CL

#include "textures/mapping.cl"

// Returns the mean over [x - width / 2, x + width / 2] of 1 where floor(x) is even and -1 where it
// is odd.
static inline float checks_mean(float x, float width) {
  const float low = x - 0.5f * width, high = x + 0.5f * width, half_low = floor(low) * 0.5f;
  // These are whole numbers as floats: their halves tell odd from even at any size.
  if (!(floor(low) != floor(high))) return half_low != floor(half_low) ? -1.0f : 1.0f;
  // The integral goes up to 1 and down again: taking points modulo 2 keeps the digits.
  const float from = low - 2.0f * floor(0.5f * low), to = from + width;
  const float before = 1.0f - fabs(from - 1.0f),
              after = 1.0f - fabs(to - 2.0f * floor(0.5f * to) - 1.0f);
  return (after - before) / width;
}

static inline float4 checkerboard_texture_at(const TexturePoint* at, __global const float* data,
                                             const float4* values) {
  __global const float* mapping = checkerboard_texture_mapping(data);
  float checks;
  if (as_uint(mapping[0]) == CAPLET_MAPPING_SOLID) {
    const TextureXYZ c = texture_xyz(at, mapping + 1);
    const float3 width = CAPLET_FILTER_SIDES * fmax(fabs(c.dx), fabs(c.dy));
    checks =
        checks_mean(c.p.x, width.x) * checks_mean(c.p.y, width.y) * checks_mean(c.p.z, width.z);
  } else {
    const TextureST c = texture_st(at, mapping);
    const float2 width = CAPLET_FILTER_SIDES * fmax(fabs(c.dx), fabs(c.dy));
    checks = checks_mean(c.st.x, width.x) * checks_mean(c.st.y, width.y);
  }
  const float4 tex1 = values[checkerboard_texture_tex1(data)],
               tex2 = values[checkerboard_texture_tex2(data)];
  if (fabs(checks) == 1.0f) return checks < 0.0f ? tex2 : tex1;
  return (0.5f + 0.5f * checks) * tex1 + (0.5f - 0.5f * checks) * tex2;
}

#endif
