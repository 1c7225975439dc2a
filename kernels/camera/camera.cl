// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This file makes camera rays. It holds the only switches over kinds of cameras.
//
// A camera of cameras.def has a file in this folder with its name, which defines
//   void NAME_ray(camera, raster, u_lens, &origin, &direction)
//       camera space, the direction of any length
//   float2 NAME_spread(camera, raster)
//       how far apart the rays of neighbouring pixels are: at the camera, and what is added to it
//       at length 1
#ifndef CAPLET_CAMERA_CAMERA_CL
#define CAPLET_CAMERA_CAMERA_CL

#include "camera/camera_types.cl"
#include "camera/{cameras}.cl"

// Returns the ray of `camera`, which stands at world_from_camera, through `raster` (pixels of the
// full image, (0, 0) the top left corner) from the lens point at u_lens in [0, 1)^2. World space,
// unit direction, t in [0, INFINITY).
static inline RayRecord camera_ray_from(__global const CameraRecord* camera,
                                        const Affine* world_from_camera, float2 raster,
                                        float2 u_lens) {
  float3 origin = (float3)(0.0f), direction = (float3)(0.0f, 0.0f, 1.0f);
  switch (camera->kind) {
#define CAMERA(name, Type)                                   \
  case camera_##name:                                        \
    name##_ray(camera, raster, u_lens, &origin, &direction); \
    break;
#include "rows/cameras.def"
#undef CAMERA
    default: break;
  }
  const float3 o = affine_point(world_from_camera, origin);
  const float3 d = normalize(affine_vector(world_from_camera, direction));
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

// Does the same where the camera stands when the shutter opens.
static inline RayRecord camera_ray(__global const CameraRecord* camera, float2 raster,
                                   float2 u_lens) {
  const Affine still = affine_load(camera->world_from_camera);
  return camera_ray_from(camera, &still, raster, u_lens);
}

static inline float2 camera_spread(__global const CameraRecord* camera, float2 raster) {
  switch (camera->kind) {
#define CAMERA(name, Type) \
  case camera_##name:      \
    return name##_spread(camera, raster);
#include "rows/cameras.def"
#undef CAMERA
    default: return (float2)(0.0f);
  }
}

#endif
