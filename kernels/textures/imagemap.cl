// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This texture is an image: it is filtered as it is, then scaled, and its colour becomes a
// spectrum. Its bottom row is at t = 0.
#ifndef CAPLET_TEXTURES_IMAGEMAP_CL
#define CAPLET_TEXTURES_IMAGEMAP_CL

#include "math/uplift.cl"
#include "textures/images.cl"
#include "textures/mapping.cl"

static inline float4 imagemap_texture_at(const TexturePoint* at, __global const float* data,
                                         const float4* values) {
  (void)values;
  const TextureST c = texture_st(at, imagemap_texture_mapping(data));
  __global const ImageRecord* image = at->materials->images + imagemap_texture_image(data);
  const uint filter = imagemap_texture_filter(data), use = imagemap_texture_use(data);
  float4 value =
      image_filtered(at->materials, image, filter, imagemap_texture_wrap(data),
                     imagemap_texture_maxanisotropy(data), (float2)(c.st.x, 1.0f - c.st.y),
                     CAPLET_FILTER_SIDES * (float2)(c.dx.x, -c.dx.y),
                     CAPLET_FILTER_SIDES * (float2)(c.dy.x, -c.dy.y));
  // As a number, a picture in colour has the mean of its channels, or its alpha where it has one.
  if (use == CAPLET_USE_NUMBER && image->channels != 1u)
    value =
        (float4)(image->channels == 4u ? value.w : (value.x + value.y + value.z) * (1.0f / 3.0f));
  value *= imagemap_texture_scale(data);
  if (imagemap_texture_invert(data) != 0u) value = fmax(1.0f - value, 0.0f);
  if (use == CAPLET_USE_NUMBER) return value;
  if (image->channels == 1u)
    return use == CAPLET_USE_ALBEDO ? clamp(value, 0.0f, 1.0f) : fmax(value, 0.0f);
  __global const float* table = at->spectra->spectrum_tables + imagemap_texture_uplift(data);
  return use == CAPLET_USE_ALBEDO ? uplift_albedo(table, value.xyz, at->lambda)
                                  : uplift_unbounded(table, value.xyz, at->lambda);
}

#endif
