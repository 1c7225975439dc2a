// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This camera sees all directions from one point by longitude and latitude, as pbrt-v4's spherical
// camera does: rows run from +y to -y, columns begin at +x and go by +z.
#ifndef CAPLET_CAMERA_EQUIRECTANGULAR_CL
#define CAPLET_CAMERA_EQUIRECTANGULAR_CL

#include "camera/camera_types.cl"

static inline void equirectangular_ray(__global const CameraRecord* camera, float2 raster,
                                       float2 u_lens, float3* origin, float3* direction) {
  (void)u_lens, (void)origin;
  float sine;
  *direction = latlong_to_sphere(
                   (float2)(raster.x * camera->per_pixel_x, raster.y * camera->per_pixel_y), &sine)
                   .xzy;
}

static inline float2 equirectangular_spread(__global const CameraRecord* camera, float2 raster) {
  const float sine = fabs(sin(CAPLET_PI * raster.y * camera->per_pixel_y));
  return (float2)(0.0f,
                  0.5f * CAPLET_PI * (2.0f * sine * camera->per_pixel_x + camera->per_pixel_y));
}

#endif
