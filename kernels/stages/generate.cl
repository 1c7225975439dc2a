// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Makes camera rays, one path a work-item. A path's random numbers depend on its pixel, its sample
// and the seed alone.
#include "camera/camera.cl"
#include "math/filter.cl"
#include "math/motion.cl"
#include "math/spectrum.cl"
#include "stages/clip_plane.cl"
#include "stages/cone_share.cl"
#include "stages/layers.cl"
#include "stages/path.cl"

// Returns a time at which the pixel is exposed: its row or column may begin later than the first.
static inline float exposure_time(__global const CameraRecord* camera, uint x, uint y, float u) {
  const float begin = camera->exposure_begin + ((float)x + 0.5f) * camera->exposure_by_x +
                      ((float)y + 0.5f) * camera->exposure_by_y;
  return clamp(begin + u * camera->exposure, 0.0f, 0x1.fffffep-1f);
}

// Returns the camera ray of a path and its weight, and gives the path its time.
static inline RayRecord camera_ray_at(const Stage* g, uint path, PathSample s, float2 raster,
                                      float2 u_lens, float* weight) {
  __global const CameraRecord* camera = g->camera.camera;
  __global const float* table = g->camera.camera_table;
  const uint segments = camera->motion_segments;
  if (!anything_moves && segments == 0u) return camera_ray(camera, table, raster, u_lens, weight);
  const float time = exposure_time(camera, s.x, s.y, sampler_1d(s, APART_SAMPLE(time)));
  if (anything_moves) g->times.path_time[path] = time;
  const Affine stands = segments == 0u ? affine_load(camera->world_from_camera)
                                       : motion_at(table, segments, 1u, 0u, time);
  return camera_ray_from(camera, table, &stands, raster, u_lens, weight);
}

static void stage_item(const Stage* g, uint path) {
  __global const ViewRecord* view = g->view.view;
  const PathSample s = path_sample(g->batch.batch, view, path);
  float filter_weight, camera_weight;
  const float2 offset =
      filter_sample(g->camera.filter_table, view->filter_width, view->filter_height,
                    sampler_2d(s, CAMERA_SAMPLE(filter)), &filter_weight);
  const float2 raster = (float2)((float)s.x + 0.5f, (float)s.y + 0.5f) + offset;
  RayRecord ray =
      camera_ray_at(g, path, s, raster, sampler_2d(s, CAMERA_SAMPLE(lens)), &camera_weight);
  int comes_in = 0;
  if (has_clip) clip_ray(view, &ray, &comes_in);
  g->rays.path_ray[path] = ray;

  float4 pdf;
  const float4 wavelengths = wavelengths_sample(g->observer.wavelength_table,
                                                sampler_1d(s, CAMERA_SAMPLE(wavelength)), &pdf);
  g->carried.path_wavelengths[path] = wavelengths;
  g->carried.path_wavelength_pdfs[path] = pdf;
  g->carried.path_throughput[path] = (float4)(filter_weight * camera_weight);
  g->carried.path_scatter[path] = (float4)(0.0f, 1.0f, 0.0f, 0.0f);
  g->carried.path_flags[path] = PATH_SPECULAR | (comes_in ? PATH_FROM_PLANE : 0u);
  g->radiance.path_radiance[path] = (float4)(0.0f);
  layers_of_nothing(g->batch.batch, path, g->layers.path_layers);
  if (has_cones)
    g->cones.path_cone[path] =
        CAPLET_CONE_SHARE * camera_spread(g->camera.camera, g->camera.camera_table, raster);
  g->queues.queue[path] = path;
}
