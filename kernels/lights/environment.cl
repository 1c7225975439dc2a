// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This file holds what the image light needs: the layout of the image on the sphere, the radiance
// between texels, and the distribution over texels.
#ifndef CAPLET_LIGHTS_ENVIRONMENT_CL
#define CAPLET_LIGHTS_ENVIRONMENT_CL

#include "lights/light_types.cl"
#include "math/spectrum.cl"
#include "math/sphere_maps.cl"
#include "math/vector.cl"
#include "shared/octahedron.h"

// Returns the texel at (x, y), each at most one beyond the image. Longitude wraps around, latitude
// repeats the pole's row, and the octahedron continues over its folded edges.
static inline float4 environment_texel(const Picture* picture, int x, int y) {
  const int width = (int)picture->width, height = (int)picture->height;
  if (picture->square) {
    fold_over_edges(&x, &y, width, height);
  } else {
    x = x < 0 ? x + width : x >= width ? x - width : x;
    y = clamp(y, 0, height - 1);
  }
  return picture_texel(picture, (size_t)y * (size_t)width + (size_t)x);
}

// Returns the radiance (before the light's scale) at uv of the image, whose colours are under
// `illuminant` (a table). It is bilinear between the radiances of texels, which stand at their
// centres.
static inline float4 environment_radiance(const Picture* picture, __global const float* illuminant,
                                          float2 uv, float4 lambda) {
  const float2 at = uv * (float2)((float)picture->width, (float)picture->height) - 0.5f;
  const float2 low = floor(at), t = at - low;
  const int x = (int)low.x, y = (int)low.y;
  const float4 r00 = sigmoid_illuminant(illuminant, environment_texel(picture, x, y), lambda);
  const float4 r10 = sigmoid_illuminant(illuminant, environment_texel(picture, x + 1, y), lambda);
  const float4 r01 = sigmoid_illuminant(illuminant, environment_texel(picture, x, y + 1), lambda);
  const float4 r11 =
      sigmoid_illuminant(illuminant, environment_texel(picture, x + 1, y + 1), lambda);
  return mix(mix(r00, r10, t.x), mix(r01, r11, t.x), t.y);
}

// Returns the cell of `cells` that u falls in, by their running sum cdf (cells + 1 entries, 0 to
// 1); never one without width.
static inline uint cdf_cell(__global const float* cdf, uint cells, float u) {
  uint low = 0, high = cells;  // cdf[low] <= u < cdf[high]
  while (high - low > 1) {
    const uint middle = (low + high) / 2;
    if (cdf[middle] <= u)
      low = middle;
    else
      high = middle;
  }
  return low;
}

static inline __global const float* environment_row(const Picture* picture, uint row) {
  return floats_at(picture->cdf, (picture->height + 1u) + (size_t)row * (picture->width + 1u));
}

// Returns the density over the unit square of the image at cell (column, row).
static inline float environment_density(const Picture* picture, uint column, uint row) {
  __global const float *conditional = environment_row(picture, row),
                       *rows = floats_at(picture->cdf, 0);
  return (rows[row + 1] - rows[row]) * (conditional[column + 1] - conditional[column]) *
         ((float)picture->width * (float)picture->height);
}

static inline float environment_solid_angle_density(const Picture* picture, float per_square,
                                                    float sine) {
  if (picture->square) return per_square * (0.25f * CAPLET_INV_PI);
  return sine > 0.0f ? per_square * (0.5f * CAPLET_INV_PI * CAPLET_INV_PI) / sine : 0.0f;
}

// Samples a direction in the light's space, its place in the image, and returns its solid-angle
// density (0: nothing).
static inline float environment_sample(const Picture* picture, float2 u, float3* direction,
                                       float2* uv) {
  const uint width = picture->width, height = picture->height;
  __global const float* rows = floats_at(picture->cdf, 0);
  const uint row = cdf_cell(rows, height, u.y);
  __global const float* conditional = environment_row(picture, row);
  const uint column = cdf_cell(conditional, width, u.x);
  const float x_begin = conditional[column], x_step = conditional[column + 1] - x_begin;
  const float y_begin = rows[row], y_step = rows[row + 1] - y_begin;
  if (!(x_step > 0.0f && y_step > 0.0f)) return 0.0f;
  *uv = (float2)(((float)column + clamp((u.x - x_begin) / x_step, 0.0f, 1.0f)) / (float)width,
                 ((float)row + clamp((u.y - y_begin) / y_step, 0.0f, 1.0f)) / (float)height);
  float sine = 1.0f;
  *direction = picture->square ? square_to_sphere(*uv) : latlong_to_sphere(*uv, &sine);
  return environment_solid_angle_density(picture, environment_density(picture, column, row), sine);
}

// Returns the place of a direction (light's space) in the image, and in *pdf the density of
// environment_sample for it.
static inline float2 environment_locate(const Picture* picture, float3 direction, float* pdf) {
  const uint width = picture->width, height = picture->height;
  float sine = 1.0f;
  const float2 uv =
      picture->square ? sphere_to_square(direction) : sphere_to_latlong(direction, &sine);
  const uint column = min((uint)(uv.x * (float)width), width - 1u),
             row = min((uint)(uv.y * (float)height), height - 1u);
  *pdf = environment_solid_angle_density(picture, environment_density(picture, column, row), sine);
  return uv;
}

#endif
