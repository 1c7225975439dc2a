// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This texture gives normals by the texels of an image that repeats: (2 r - 1, 2 g - 1, 2 b - 1) in
// the frame of the surface.
#ifndef CAPLET_TEXTURES_NORMALMAP_CL
#define CAPLET_TEXTURES_NORMALMAP_CL

#include "textures/images.cl"

static inline float4 normalmap_texture_at(const TexturePoint* at, __global const float* data,
                                          const float4* values) {
  (void)values;
  __global const ImageRecord* image = at->materials->images + normalmap_texture_image(data);
  const float2 st = (float2)(at->place.uv.x, 1.0f - at->place.uv.y);
  return 2.0f * image_bilinear(at->materials, image, 0u, CAPLET_WRAP_REPEAT,
                               image_st(st, CAPLET_WRAP_REPEAT)) -
         1.0f;
}

#endif
