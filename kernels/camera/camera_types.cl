// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This file holds what cameras share: the image plane and the lens.
#ifndef CAPLET_CAMERA_CAMERA_TYPES_CL
#define CAPLET_CAMERA_CAMERA_TYPES_CL

#include "math/sphere_maps.cl"
#include "math/vector.cl"
#include "shared/records.h"

// Returns the place of `raster` on the image plane, in camera units.
static inline float2 plane_place(__global const CameraRecord* camera, float2 raster) {
  return (float2)(camera->plane_x + raster.x * camera->per_pixel_x,
                  camera->plane_y + raster.y * camera->per_pixel_y);
}

// Returns the mean width and height of a pixel on the image plane.
static inline float plane_spread(__global const CameraRecord* camera) {
  return 0.5f * (fabs(camera->per_pixel_x) + fabs(camera->per_pixel_y));
}

// Returns a point of the regular polygon with corners at distance 1, uniformly: one of the
// triangles around its middle, and a point of that.
static inline float2 sample_blades(__global const CameraRecord* camera, float2 u) {
  const float scaled = u.x * (float)camera->blades;
  const uint blade = min((uint)scaled, camera->blades - 1u);
  const float step = 2.0f * CAPLET_PI / (float)camera->blades;
  const float from = camera->blade_rotation + step * (float)blade, to = from + step;
  const float away = sqrt(scaled - (float)blade);
  return away * mix((float2)(cos(from), sin(from)), (float2)(cos(to), sin(to)), u.y);
}

// Moves a ray, whose direction has z = 1, to a point of the lens: what lies at the focal distance
// stays where it is.
static inline void through_lens(__global const CameraRecord* camera, float2 u_lens, float3* origin,
                                float3* direction) {
  if (!(camera->lens_radius > 0.0f)) return;
  const float2 lens = camera->lens_radius *
                      (camera->blades > 0u ? sample_blades(camera, u_lens) : sample_disk(u_lens));
  const float3 aside = (float3)(lens.x, lens.y, 0.0f);
  *origin += aside;
  // Dividing by that distance keeps the numbers near 1.
  *direction -= aside / camera->focal_distance;
}

#endif
