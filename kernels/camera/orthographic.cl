// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This camera sends parallel rays from the plane z = 0, through a lens at each of its points.
#ifndef CAPLET_CAMERA_ORTHOGRAPHIC_CL
#define CAPLET_CAMERA_ORTHOGRAPHIC_CL

#include "camera/camera_types.cl"

static inline float orthographic_ray(__global const CameraRecord* camera,
                                     __global const float* camera_table, float2 raster,
                                     float2 u_lens, float3* origin, float3* direction) {
  (void)camera_table;
  *origin = (float3)(plane_place(camera, raster), 0.0f);
  through_lens(camera, u_lens, origin, direction);
  return 1.0f;
}

static inline float2 orthographic_spread(__global const CameraRecord* camera,
                                         __global const float* camera_table, float2 raster) {
  (void)camera_table;
  (void)raster;
  return (float2)(plane_spread(camera), 0.0f);
}

#endif
