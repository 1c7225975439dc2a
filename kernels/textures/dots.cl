// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This texture has disks of radius 0.35 in some of the unit squares about whole points, moved
// within them at random.
#ifndef CAPLET_TEXTURES_DOTS_CL
#define CAPLET_TEXTURES_DOTS_CL

#include "textures/noise.cl"

static inline float dots_noise(float x, float y) { return noise_at((float3)(x, y, 0.5f)); }

static inline float4 dots_texture_at(const TexturePoint* at, __global const float* data,
                                     const float4* values) {
  const float2 st = texture_st(at, dots_texture_mapping(data)).st, cell = floor(st + 0.5f);
  int inside = 0;
  if (dots_noise(cell.x + 0.5f, cell.y + 0.5f) > 0.0f) {
    const float2 center = cell + 0.15f * (float2)(dots_noise(cell.x + 1.5f, cell.y + 2.8f),
                                                  dots_noise(cell.x + 4.5f, cell.y + 9.8f));
    inside = dot(st - center, st - center) < 0.35f * 0.35f;
  }
  return values[inside ? dots_texture_inside(data) : dots_texture_outside(data)];
}

#endif
