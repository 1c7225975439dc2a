// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This is a thin-lens camera whose image plane is z = 1.
#ifndef CAPLET_CAMERA_PERSPECTIVE_CL
#define CAPLET_CAMERA_PERSPECTIVE_CL

#include "camera/camera_types.cl"

static inline float perspective_ray(__global const CameraRecord* camera,
                                    __global const float* camera_table, float2 raster,
                                    float2 u_lens, float3* origin, float3* direction) {
  (void)camera_table;
  *direction = (float3)(plane_place(camera, raster), 1.0f);
  through_lens(camera, u_lens, origin, direction);
  return 1.0f;
}

static inline float2 perspective_spread(__global const CameraRecord* camera,
                                        __global const float* camera_table, float2 raster) {
  (void)camera_table;
  return (float2)(0.0f, plane_spread(camera) / length((float3)(plane_place(camera, raster), 1.0f)));
}

#endif
