// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Camera rays: of a thin-lens perspective camera, or of an orthographic one.
#ifndef CAPLET_MATH_CAMERA_CL
#define CAPLET_MATH_CAMERA_CL

#include "math/vector.cl"
#include "shared/records.h"

// The ray of `camera` through `raster` (pixels of the full image, (0, 0) the top left corner) from the lens point at u_lens in [0, 1)^2.
// World space, unit direction, t in [0, INFINITY).
static inline RayRecord camera_ray(__global const CameraRecord* camera, float2 raster, float2 u_lens) {
  float3 direction = (float3)(camera->screen_min_x + raster.x * camera->screen_per_pixel_x,
                              camera->screen_min_y + raster.y * camera->screen_per_pixel_y, 1.0f);
  float3 origin = (float3)(0.0f);
  if (camera->origins == CAPLET_ORTHOGRAPHIC) {
    origin = (float3)(direction.x, direction.y, 0.0f);
    direction = (float3)(0.0f, 0.0f, 1.0f);
  }
  if (camera->lens_radius > 0.0f) {
    const float2 lens = camera->lens_radius * sample_disk(u_lens);
    const float3 aside = (float3)(lens.x, lens.y, 0.0f);
    origin += aside;
    // What lies at the focal distance stays where it is; dividing by that distance keeps the numbers near 1.
    direction -= aside / camera->focal_distance;
  }
  const float3 o = transform_point(camera->world_from_camera, origin);
  const float3 d = normalize(transform_vector(camera->world_from_camera, direction));
  RayRecord ray;
  ray.ox = o.x;
  ray.oy = o.y;
  ray.oz = o.z;
  ray.t_min = 0.0f;
  ray.dx = d.x;
  ray.dy = d.y;
  ray.dz = d.z;
  ray.t_max = INFINITY;
  return ray;
}

// How far apart the rays of neighbouring pixels are: at the camera, and what comes to it at length 1.
static inline float2 camera_spread(__global const CameraRecord* camera, float2 raster) {
  if (camera->origins == CAPLET_ORTHOGRAPHIC)
    return (float2)(0.5f * (fabs(camera->screen_per_pixel_x) + fabs(camera->screen_per_pixel_y)), 0.0f);
  const float3 direction = (float3)(camera->screen_min_x + raster.x * camera->screen_per_pixel_x,
                                    camera->screen_min_y + raster.y * camera->screen_per_pixel_y, 1.0f);
  return (float2)(0.0f, 0.5f * (fabs(camera->screen_per_pixel_x) + fabs(camera->screen_per_pixel_y)) / length(direction));
}

#endif
