// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This file makes camera rays. It holds the only switches over kinds of cameras.
//
// A camera of cameras.def has a file in this folder with its name, which defines
//   float NAME_ray(camera, camera_table, raster, u_lens, &origin, &direction)
//       camera space, the direction of any length; returns the weight of its radiance, 0 or less
//       where the camera stops it; below 0 it sees nothing
//   float2 NAME_spread(camera, camera_table, raster)
//       how far apart the rays of neighbouring pixels are: at the camera, and what is added to it
//       at length 1
#ifndef CAPLET_CAMERA_CAMERA_CL
#define CAPLET_CAMERA_CAMERA_CL

#include "camera/camera_types.cl"
#include "camera/{cameras}.cl"

// Returns the ray of `camera`, which stands at world_from_camera, through `raster` (pixels of the
// full image, (0, 0) the top left corner) from the lens point at u_lens in [0, 1)^2. World space,
// unit direction, t in [0, INFINITY); [0, -1] where it sees nothing. Gives its radiance's weight.
static inline RayRecord camera_ray_from(__global const CameraRecord* camera,
                                        __global const float* camera_table,
                                        const Affine* world_from_camera, float2 raster,
                                        float2 u_lens, float* weight) {
  float3 origin = (float3)(0.0f), direction = (float3)(0.0f, 0.0f, 1.0f);
  float passes = 1.0f;
  switch (camera->kind) {
#define CAMERA(name, Type)                                                          \
  case camera_##name:                                                               \
    passes = name##_ray(camera, camera_table, raster, u_lens, &origin, &direction); \
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
  ray.t_max = passes < 0.0f ? -1.0f : INFINITY;
  *weight = fmax(passes, 0.0f);
  return ray;
}

// Does the same where the camera stands when the shutter opens.
static inline RayRecord camera_ray(__global const CameraRecord* camera,
                                   __global const float* camera_table, float2 raster, float2 u_lens,
                                   float* weight) {
  const Affine still = affine_load(camera->world_from_camera);
  return camera_ray_from(camera, camera_table, &still, raster, u_lens, weight);
}

static inline float2 camera_spread(__global const CameraRecord* camera,
                                   __global const float* camera_table, float2 raster) {
  switch (camera->kind) {
#define CAMERA(name, Type) \
  case camera_##name:      \
    return name##_spread(camera, camera_table, raster);
#include "rows/cameras.def"
#undef CAMERA
    default: return (float2)(0.0f);
  }
}

#endif
