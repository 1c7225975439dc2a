// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Camera rays: one path a work-item. A path's numbers depend on its pixel, its sample and the seed alone.
#include "globals.cl"
#include "math/camera.cl"
#include "math/filter.cl"
#include "math/rng.cl"
#include "math/spectrum.cl"
#include "stages/path.cl"

#define STAGE_NAME generate
static void stage_item(const Globals* g, uint path) {
  const PathSample s = path_sample(g, path);
  float filter_weight;
  const float2 offset = filter_sample(g, sampler_2d(s.seed, s.sample, SAMPLE_FILTER), &filter_weight);
  const float2 raster = (float2)((float)s.x + 0.5f, (float)s.y + 0.5f) + offset;
  g->path_ray[path] = camera_ray(g, raster, sampler_2d(s.seed, s.sample, SAMPLE_LENS));

  float4 pdf;
  const float4 wavelengths = wavelengths_sample(g, sampler_1d(s.seed, s.sample, SAMPLE_WAVELENGTH), &pdf);
  vstore4(wavelengths, path, g->path_wavelengths);
  vstore4(pdf, path, g->path_wavelength_pdfs);
  vstore4((float4)(filter_weight), path, g->path_throughput);
  vstore4((float4)(0.0f), path, g->path_radiance);
  vstore4((float4)(0.0f, 1.0f, 0.0f, filter_weight), path, g->path_scatter);
  vstore4((float4)(0.0f), path, g->path_albedo);
  vstore4((float4)(0.0f, 0.0f, 0.0f, as_float(CAPLET_NONE)), path, g->path_normal);
  vstore4((float4)(0.0f, 0.0f, 0.0f, as_float(CAPLET_NONE)), path, g->path_position);
  g->path_flags[path] = PATH_SPECULAR;
  g->queue[path] = path;
}
#include "stages/kernel.cl"
