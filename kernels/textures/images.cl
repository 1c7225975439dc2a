// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This file reads images of textures: texels, values beyond their edges, and filters by mip levels.
#ifndef CAPLET_TEXTURES_IMAGES_CL
#define CAPLET_TEXTURES_IMAGES_CL

#include "textures/texture_types.cl"
#include "shared/octahedron.h"

// Returns x modulo n, from 0 on, for any x.
static inline int repeated(int x, int n) {
  x %= n;
  return x < 0 ? x + n : x;
}

// Returns where a level's numbers are: where its texels begin, width, height, format.
static inline __global const uint* image_level(const Materials* materials,
                                               __global const ImageRecord* image, uint level) {
  return (__global const uint*)floats_at(texels_of(materials), image->levels_begin + 4u * level);
}

// Returns texel (x, y) of a level, which may lie beyond its edges: grey in all channels, or red,
// green, blue and alpha.
static inline float4 image_texel(const Materials* materials, __global const ImageRecord* image,
                                 uint level, uint wrap, int x, int y) {
  const Floats texels = texels_of(materials);
  __global const uint* of = image_level(materials, image, level);
  const int width = (int)of[1], height = (int)of[2];
  if (wrap == CAPLET_WRAP_REPEAT) {
    x = repeated(x, width);
    y = repeated(y, height);
  } else if (wrap == CAPLET_WRAP_OCTAHEDRAL) {
    fold_over_edges(&x, &y, width, height);  // filters go one texel beyond
  } else if (wrap == CAPLET_WRAP_BLACK && (x < 0 || y < 0 || x >= width || y >= height)) {
    return (float4)(0.0f);
  }
  x = clamp(x, 0, width - 1);
  y = clamp(y, 0, height - 1);
  const uint channels = image->channels, at = ((uint)y * (uint)width + (uint)x) * channels;
  if (of[3] == CAPLET_TEXELS_FLOATS) {
    __global const float* values = floats_at(texels, (size_t)of[0] + at);
    if (channels == 1u) return (float4)(values[0]);
    return (float4)(values[0], values[1], values[2], channels == 4u ? values[3] : 1.0f);
  }
  __global const float* decoded = floats_at(texels, image->decode);
  if (of[3] == CAPLET_TEXELS_NUMBERS) {
    __global const ushort* numbers =
        (__global const ushort*)bytes_at(texels, of[0], (size_t)at * 2u);
    if (channels == 1u) return (float4)(decoded[numbers[0]]);
    return (float4)(decoded[numbers[0]], decoded[numbers[1]], decoded[numbers[2]],
                    channels == 4u ? decoded[numbers[3]] : 1.0f);
  }
  __global const uchar* bytes = bytes_at(texels, of[0], at);
  if (channels == 1u) return (float4)(decoded[bytes[0]]);
  return (float4)(decoded[bytes[0]], decoded[bytes[1]], decoded[bytes[2]],
                  channels == 4u ? (float)bytes[3] * (1.0f / 255.0f) : 1.0f);
}

// Limits st to where an image is evaluated: one that repeats is the same everywhere, and the others
// do not change far away.
static inline float2 image_st(float2 st, uint wrap) {
  if (!isfinite(st.x + st.y)) return (float2)(0.0f);
  return wrap == CAPLET_WRAP_REPEAT ? st - floor(st) : clamp(st, -4.0f, 5.0f);
}

// Interpolates between the texels about a point; (0, 0) is the corner of the first texel, (1, 1)
// that of the last.
static inline float4 image_bilinear(const Materials* materials, __global const ImageRecord* image,
                                    uint level, uint wrap, float2 st) {
  __global const uint* of = image_level(materials, image, level);
  const float x = st.x * (float)of[1] - 0.5f, y = st.y * (float)of[2] - 0.5f;
  const int x0 = (int)floor(x), y0 = (int)floor(y);
  const float u = x - floor(x), v = y - floor(y);
  const float4 top = (1.0f - u) * image_texel(materials, image, level, wrap, x0, y0) +
                     u * image_texel(materials, image, level, wrap, x0 + 1, y0);
  const float4 low = (1.0f - u) * image_texel(materials, image, level, wrap, x0, y0 + 1) +
                     u * image_texel(materials, image, level, wrap, x0 + 1, y0 + 1);
  return (1.0f - v) * top + v * low;
}

static inline float4 image_point(const Materials* materials, __global const ImageRecord* image,
                                 uint level, uint wrap, float2 st) {
  __global const uint* of = image_level(materials, image, level);
  return image_texel(materials, image, level, wrap, (int)floor(st.x * (float)of[1]),
                     (int)floor(st.y * (float)of[2]));
}

// Interpolates between the levels about `level`, a number of halvings.
static inline float4 image_trilinear(const Materials* materials, __global const ImageRecord* image,
                                     float level, uint wrap, float2 st) {
  const uint last = image->levels - 1u;
  if (!(level > 0.0f)) return image_bilinear(materials, image, 0u, wrap, st);
  if (!(level < (float)last)) return image_bilinear(materials, image, last, wrap, st);
  const uint below = (uint)level;
  const float part = level - (float)below;
  return (1.0f - part) * image_bilinear(materials, image, below, wrap, st) +
         part * image_bilinear(materials, image, below + 1u, wrap, st);
}

// Returns the image at st; dx, dy: the sides of the footprint to be averaged. Filters by their
// names (kinds.h): all but EWA take the level whose texels are as large as the greatest extent of
// the sides; EWA takes samples along the longer side with the level of the shorter one, at most
// max_anisotropy times.
static inline float4 image_filtered(const Materials* materials, __global const ImageRecord* image,
                                    uint filter, uint wrap, float max_anisotropy, float2 st,
                                    float2 dx, float2 dy) {
  __global const uint* of = image_level(materials, image, 0);
  const float2 size = (float2)((float)of[1], (float)of[2]);
  dx *= size;
  dy *= size;
  if (filter == CAPLET_FILTER_EWA) {
    const int x_is_longer = dot(dx, dx) >= dot(dy, dy);
    float2 along = x_is_longer ? dx : dy;
    const float longer = sqrt(dot(along, along)),
                shorter = x_is_longer ? sqrt(dot(dy, dy)) : sqrt(dot(dx, dx));
    const float most = clamp(max_anisotropy, 1.0f, 16.0f);
    // Probes are at least a texel wide, also where the shorter side is less.
    const float wide = fmax(fmax(shorter, longer / most), 1.0f);
    const int probes = isfinite(longer) ? clamp((int)ceil(longer / wide), 1, 16) : 1;
    along /= size;
    float4 sum = (float4)(0.0f);
    for (int i = 0; i < probes; ++i) {
      const float2 where = st + (((float)i + 0.5f) / (float)probes - 0.5f) * along;
      sum += image_trilinear(materials, image, isfinite(longer) ? log2(wide) : 64.0f, wrap,
                             image_st(where, wrap));
    }
    return sum / (float)probes;
  }
  const float2 extent = fmax(fabs(dx), fabs(dy));
  const float texels = fmax(extent.x, extent.y), level = texels > 1.0f ? log2(texels) : 0.0f;
  st = image_st(st, wrap);
  if (filter == CAPLET_FILTER_TRILINEAR) return image_trilinear(materials, image, level, wrap, st);
  const uint whole = min((uint)fmin(level, 64.0f), image->levels - 1u);
  return filter == CAPLET_FILTER_POINT ? image_point(materials, image, whole, wrap, st)
                                       : image_bilinear(materials, image, whole, wrap, st);
}

#endif
