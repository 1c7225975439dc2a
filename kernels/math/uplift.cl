// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Converts colours to spectra: sigmoid polynomials (Jakob and Hanika 2019) by a table over which
// channel is the largest, its value, and the two others as parts of it (limits.h;
// host/lower/spectrum_uplift.cpp makes it).
#ifndef CAPLET_MATH_UPLIFT_CL
#define CAPLET_MATH_UPLIFT_CL

#include "math/spectrum.cl"

// Returns the first of the two nodes of an axis about x in [0, 1], and the fraction to the second.
static inline uint uplift_node(float x, uint nodes, float* fraction) {
  const float at = clamp(x, 0.0f, 1.0f) * (float)(nodes - 1u);
  const uint node = min((uint)at, nodes - 2u);
  *fraction = at - (float)node;
  return node;
}

static inline float3 uplift_between(__global const float* cell, uint stride, float fraction) {
  const float3 low = load3(cell);
  return low + fraction * (load3(cell + stride) - low);
}

// Returns the coefficients of a colour whose channels are in [0, 1] and not all the same. They grow
// as its value falls, as one over the root, so the table holds them without that factor.
static inline float3 uplift_coefficients(__global const float* table, float3 rgb) {
  const uint top = rgb.x >= rgb.y ? (rgb.x >= rgb.z ? 0u : 2u) : (rgb.y >= rgb.z ? 1u : 2u);
  const float3 turned = top == 0u ? rgb : top == 1u ? rgb.yzx : rgb.zxy;
  const float value = fmax(turned.x, 1e-10f);
  float x, y, z;
  const uint column = uplift_node(sqrt(fmin(turned.y / value, 1.0f)), CAPLET_UPLIFT_RATIOS, &x);
  const uint row = uplift_node(sqrt(fmin(turned.z / value, 1.0f)), CAPLET_UPLIFT_RATIOS, &y);
  const uint layer = uplift_node(1.0f - sqrt(1.0f - value), CAPLET_UPLIFT_VALUES, &z);
  const uint row_floats = 3u * CAPLET_UPLIFT_RATIOS,
             layer_floats = row_floats * CAPLET_UPLIFT_RATIOS;
  __global const float* cell =
      table + (top * CAPLET_UPLIFT_VALUES + layer) * layer_floats + row * row_floats + 3u * column;
  const float3 near_low = uplift_between(cell, 3u, x),
               near_high = uplift_between(cell + row_floats, 3u, x);
  const float3 far_low = uplift_between(cell + layer_floats, 3u, x),
               far_high = uplift_between(cell + layer_floats + row_floats, 3u, x);
  const float3 near = near_low + y * (near_high - near_low),
               far = far_low + y * (far_high - far_low);
  return (near + z * (far - near)) / sqrt(value);
}

// Returns a reflectance of the colour, whose channels are clamped to [0, 1], at four wavelengths
// (nm).
static inline float4 uplift_albedo(__global const float* table, float3 rgb, float4 lambda) {
  rgb = clamp(rgb, 0.0f, 1.0f);
  if (rgb.x == rgb.y && rgb.y == rgb.z) return (float4)(rgb.x);
  const float3 c = uplift_coefficients(table, rgb);
  return sigmoid_polynomial(c.x, c.y, c.z, lambda);
}

// Returns a spectrum from 0 up: twice the largest channel times that of the colour with a largest
// channel of 1/2.
static inline float4 uplift_unbounded(__global const float* table, float3 rgb, float4 lambda) {
  rgb = fmax(rgb, 0.0f);
  const float scale = 2.0f * max3(rgb);
  if (!(scale > 0.0f) || (rgb.x == rgb.y && rgb.y == rgb.z)) return (float4)(rgb.x);
  return scale * uplift_albedo(table, rgb / scale, lambda);
}

#endif
