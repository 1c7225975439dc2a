// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This camera sees all directions from one point, as pbrt-v4's spherical camera does. By the
// equal-area octahedral map (mapping 0) the middle of the image looks along +y; by longitude and
// latitude (1) rows run from +y to -y, columns begin at +x and go by +z.
#ifndef CAPLET_CAMERA_SPHERICAL_CL
#define CAPLET_CAMERA_SPHERICAL_CL

#include "camera/camera_types.cl"

static inline float spherical_ray(__global const CameraRecord* camera,
                                  __global const float* camera_table, float2 raster, float2 u_lens,
                                  float3* origin, float3* direction) {
  (void)camera_table, (void)u_lens, (void)origin;
  float2 uv = (float2)(raster.x * camera->per_pixel_x, raster.y * camera->per_pixel_y);
  if (camera->mapping == 1u) {
    float sine;
    *direction = latlong_to_sphere(uv, &sine).xzy;
    return 1.0f;
  }
  // The pixel filter reaches beyond the image: over an edge of the square lies the other half of
  // that edge.
  if (uv.x < 0.0f || uv.x > 1.0f) uv = (float2)(uv.x < 0.0f ? -uv.x : 2.0f - uv.x, 1.0f - uv.y);
  if (uv.y < 0.0f || uv.y > 1.0f) uv = (float2)(1.0f - uv.x, uv.y < 0.0f ? -uv.y : 2.0f - uv.y);
  *direction = square_to_sphere(uv).xzy;
  return 1.0f;
}

static inline float2 spherical_spread(__global const CameraRecord* camera,
                                      __global const float* camera_table, float2 raster) {
  (void)camera_table;
  const float across = camera->per_pixel_x, down = camera->per_pixel_y;
  if (camera->mapping == 1u) {
    const float sine = fabs(sin(CAPLET_PI * raster.y * down));
    return (float2)(0.0f, 0.5f * CAPLET_PI * (2.0f * sine * across + down));
  }
  // A pixel's share of the sphere is 4 pi over their number.
  return (float2)(0.0f, sqrt(4.0f * CAPLET_PI * across * down));
}

#endif
