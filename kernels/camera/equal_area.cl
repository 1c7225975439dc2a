// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This camera sees all directions from one point by the equal-area octahedral map, as pbrt-v4's
// spherical camera does: the middle of the image looks along +y.
#ifndef CAPLET_CAMERA_EQUAL_AREA_CL
#define CAPLET_CAMERA_EQUAL_AREA_CL

#include "camera/camera_types.cl"

static inline void equal_area_ray(__global const CameraRecord* camera, float2 raster, float2 u_lens,
                                  float3* origin, float3* direction) {
  (void)u_lens, (void)origin;
  float2 uv = (float2)(raster.x * camera->per_pixel_x, raster.y * camera->per_pixel_y);
  // The pixel filter reaches beyond the image: over an edge of the square lies the other half of
  // that edge.
  if (uv.x < 0.0f || uv.x > 1.0f) uv = (float2)(uv.x < 0.0f ? -uv.x : 2.0f - uv.x, 1.0f - uv.y);
  if (uv.y < 0.0f || uv.y > 1.0f) uv = (float2)(1.0f - uv.x, uv.y < 0.0f ? -uv.y : 2.0f - uv.y);
  *direction = square_to_sphere(uv).xzy;
}

// A pixel's share of the sphere is 4 pi over their number.
static inline float2 equal_area_spread(__global const CameraRecord* camera, float2 raster) {
  (void)raster;
  return (float2)(0.0f, sqrt(4.0f * CAPLET_PI * camera->per_pixel_x * camera->per_pixel_y));
}

#endif
