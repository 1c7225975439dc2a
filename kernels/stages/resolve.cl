// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Finished paths to the film: one work-item a pixel adds its samples in order with compensated sums (Kahan 1965), so that how
// samples were split into batches cannot change a bit, and that a million of them lose nothing.
#include "globals.cl"
#include "math/vector.cl"
#include "math/spectrum.cl"
#include "stages/path.cl"

static inline void add_compensated(float* sum, float* low, float value) {
  const float y = value - *low;
  const float t = *sum + y;
  *low = (t - *sum) - y;
  *sum = t;
}

static inline void add_compensated3(float* sum, float* low, float3 value) {
  add_compensated(sum, low, value.x);
  add_compensated(sum + 1, low + 1, value.y);
  add_compensated(sum + 2, low + 2, value.z);
}

#define STAGE_NAME resolve
static void stage_item(const Globals* g, uint item) {
  __global const ParamsRecord* params = g->params;
  FilmRecord film = g->film[params->pixel_begin + item];
  for (uint i = 0; i < params->sample_count; ++i) {
    const uint path = item * params->sample_count + i;
    const float4 radiance = vload4(path, g->path_radiance);
    float3 xyz = xyz_from_spectrum(g, radiance, vload4(path, g->path_wavelengths), vload4(path, g->path_wavelength_pdfs));
    if (!all(isfinite(radiance)) || !all(isfinite(xyz))) {
      xyz = (float3)(0.0f);
      atomic_inc(&g->counters[COUNTER_NOT_FINITE]);
    }
    const float3 rgb = rgb_from_xyz(params->rgb_from_xyz, xyz);
    add_compensated3(film.xyz, film.xyz_low, xyz);
    add_compensated3(film.rgb_squared, film.rgb_squared_low, rgb * rgb);

    const float4 albedo = vload4(path, g->path_albedo);
    const float4 normal = vload4(path, g->path_normal);
    const float4 position = vload4(path, g->path_position);
    if (film.samples == 0) {
      film.object = as_uint(normal.w);
      film.primitive = as_uint(position.w);
    }
    film.samples += 1;
    if (as_uint(normal.w) != CAPLET_NONE) {
      film.hits += 1;
      add_compensated3(film.albedo, film.albedo_low, albedo.xyz);
      add_compensated3(film.normal, film.normal_low, normal.xyz);
      add_compensated3(film.position, film.position_low, position.xyz);
      add_compensated(&film.depth, &film.depth_low, albedo.w);
    }
  }
  g->film[params->pixel_begin + item] = film;
}
#include "stages/kernel.cl"
