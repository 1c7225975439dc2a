// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Makes camera rays, one path a work-item. A path's random numbers depend on its pixel, its sample
// and the seed alone.
#include "camera/camera.cl"
#include "math/filter.cl"
#include "math/spectrum.cl"
#include "stages/cone_share.cl"
#include "stages/layers.cl"
#include "stages/path.cl"

static void stage_item(const Stage* g, uint path) {
  __global const ViewRecord* view = g->view.view;
  const PathSample s = path_sample(g->batch.batch, view, path);
  float filter_weight;
  const float2 offset =
      filter_sample(g->camera.filter_table, view->filter_width, view->filter_height,
                    sampler_2d(s, CAMERA_SAMPLE(filter)), &filter_weight);
  const float2 raster = (float2)((float)s.x + 0.5f, (float)s.y + 0.5f) + offset;
  g->rays.path_ray[path] = camera_ray(g->camera.camera, raster, sampler_2d(s, CAMERA_SAMPLE(lens)));

  float4 pdf;
  const float4 wavelengths = wavelengths_sample(g->observer.wavelength_table,
                                                sampler_1d(s, CAMERA_SAMPLE(wavelength)), &pdf);
  g->carried.path_wavelengths[path] = wavelengths;
  g->carried.path_wavelength_pdfs[path] = pdf;
  g->carried.path_throughput[path] = (float4)(filter_weight);
  g->carried.path_scatter[path] = (float4)(0.0f, 1.0f, 0.0f, 0.0f);
  g->carried.path_flags[path] = PATH_SPECULAR;
  g->radiance.path_radiance[path] = (float4)(0.0f);
  layers_of_nothing(g->batch.batch, path, g->layers.path_layers);
  if (has_cones)
    g->cones.path_cone[path] = CAPLET_CONE_SHARE * camera_spread(g->camera.camera, raster);
  g->queues.queue[path] = path;
}
