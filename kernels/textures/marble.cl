// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This texture has layers along y, bent by noise, in pbrt-v4's colours.
#ifndef CAPLET_TEXTURES_MARBLE_CL
#define CAPLET_TEXTURES_MARBLE_CL

#include "math/uplift.cl"
#include "textures/noise.cl"

// These are control points of the colours: six cubic Bezier curves, each of which takes four
// points, one further on than the last.
__constant float marble_colors[27] = {0.58f, 0.58f, 0.6f, 0.58f, 0.58f, 0.6f,  0.58f, 0.58f, 0.6f,
                                      0.5f,  0.5f,  0.5f, 0.6f,  0.59f, 0.58f, 0.58f, 0.58f, 0.6f,
                                      0.58f, 0.58f, 0.6f, 0.2f,  0.2f,  0.33f, 0.58f, 0.58f, 0.6f};

static inline float3 marble_color(int i) {
  return (float3)(marble_colors[3 * i], marble_colors[3 * i + 1], marble_colors[3 * i + 2]);
}

static inline float4 marble_texture_at(const TexturePoint* at, __global const float* data,
                                       const float4* values) {
  (void)values;
  const float scale = marble_texture_scale(data);
  TextureXYZ c = texture_xyz(at, marble_texture_place(data));
  c.p *= scale;
  c.dx *= scale;
  c.dy *= scale;
  const float depth =
      c.p.y + marble_texture_variation(data) *
                  noise_fbm(c, marble_texture_roughness(data), marble_texture_octaves(data));
  const float along = 6.0f * (0.5f + 0.5f * sin(depth));
  const int first = clamp((int)along, 0, 5);
  const float t = along - (float)first, s = 1.0f - t;
  const float3 rgb = s * s * s * marble_color(first) + 3.0f * s * s * t * marble_color(first + 1) +
                     3.0f * s * t * t * marble_color(first + 2) +
                     t * t * t * marble_color(first + 3);
  return uplift_albedo(at->spectra->spectrum_tables + marble_texture_uplift(data), 1.5f * rgb,
                       at->lambda);
}

#endif
