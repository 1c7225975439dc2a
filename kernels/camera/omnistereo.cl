// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This camera is one eye of a head that looks around (host/scene/cameras/omnistereo.h). Rows run
// from +y to -y; the middle column looks along +z, and those to its right to the right.
#ifndef CAPLET_CAMERA_OMNISTEREO_CL
#define CAPLET_CAMERA_OMNISTEREO_CL

#include "camera/camera_types.cl"

static inline float omnistereo_ray(__global const CameraRecord* camera,
                                   __global const float* camera_table, float2 raster, float2 u_lens,
                                   float3* origin, float3* direction) {
  (void)camera_table, (void)u_lens;
  const float azimuth = 2.0f * CAPLET_PI * (raster.x * camera->per_pixel_x - 0.5f),
              polar = CAPLET_PI * raster.y * camera->per_pixel_y;
  const float s = sin(azimuth), c = cos(azimuth), across = sin(polar);
  *origin = camera->distortion[0] * (float3)(c, 0.0f, -s);
  *direction = (float3)(across * s, cos(polar), across * c);
  return 1.0f;
}

static inline float2 omnistereo_spread(__global const CameraRecord* camera,
                                       __global const float* camera_table, float2 raster) {
  (void)camera_table;
  const float across = camera->per_pixel_x, down = camera->per_pixel_y;
  const float sine = fabs(sin(CAPLET_PI * raster.y * down));
  return (float2)(0.0f, 0.5f * CAPLET_PI * (2.0f * sine * across + down));
}

#endif
