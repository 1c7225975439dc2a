// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This texture has waves of a height that varies slowly, as wind makes them, with pbrt-v4's numbers
// of octaves.
#ifndef CAPLET_TEXTURES_WINDY_CL
#define CAPLET_TEXTURES_WINDY_CL

#include "textures/noise.cl"

static inline float4 windy_texture_at(const TexturePoint* at, __global const float* data,
                                      const float4* values) {
  (void)values;
  const TextureXYZ c = texture_xyz(at, windy_texture_place(data)),
                   slow = {0.1f * c.p, 0.1f * c.dx, 0.1f * c.dy};
  return (float4)(fabs(noise_fbm(slow, 0.5f, 3u)) * noise_fbm(c, 0.5f, 6u));
}

#endif
