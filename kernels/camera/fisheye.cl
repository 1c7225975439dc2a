// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This camera sees from one point. The angle to its axis is the distance from the picture's middle
// (mapping 0, equidistant), or twice the arc sine of it (1, equisolid), to straight behind.
#ifndef CAPLET_CAMERA_FISHEYE_CL
#define CAPLET_CAMERA_FISHEYE_CL

#include "camera/camera_types.cl"

static inline float fisheye_angle(__global const CameraRecord* camera, float r) {
  return camera->mapping == 0u ? fmin(r, CAPLET_PI) : 2.0f * asin(fmin(r, 1.0f));
}

static inline float fisheye_ray(__global const CameraRecord* camera,
                                __global const float* camera_table, float2 raster, float2 u_lens,
                                float3* origin, float3* direction) {
  (void)camera_table, (void)u_lens, (void)origin;
  const float2 place = plane_place(camera, raster);
  const float r = length(place), angle = fisheye_angle(camera, r);
  *direction = (float3)(r > 0.0f ? place * (sin(angle) / r) : (float2)(0.0f), cos(angle));
  return 1.0f;
}

// The mean of the angles of a pixel away from the middle and around it.
static inline float2 fisheye_spread(__global const CameraRecord* camera,
                                    __global const float* camera_table, float2 raster) {
  (void)camera_table;
  const float r = length(plane_place(camera, raster)), angle = fisheye_angle(camera, r);
  const float outward = camera->mapping == 0u ? 1.0f : 2.0f / fmax(1e-3f, cos(0.5f * angle));
  const float around = r > 0.0f ? sin(angle) / r : outward;
  return (float2)(0.0f, 0.5f * (outward + around) * plane_spread(camera));
}

#endif
