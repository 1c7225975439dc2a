// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Finished paths to the film: one work-item a pixel adds its samples in order with compensated sums (Kahan 1965), so that how
// samples were split into batches cannot change a bit.
#include "globals.cl"
#include "math/vector.cl"
#include "math/spectrum.cl"
#include "stages/path.cl"

static inline void add_compensated(__global float* sum, __global float* low, float value) {
  const float y = value - *low;
  const float t = *sum + y;
  *low = (t - *sum) - y;
  *sum = t;
}

#define STAGE_NAME resolve
static void stage_item(const Globals* g, uint item) {
  __global const ParamsRecord* params = g->params;
  __global FilmRecord* film = &g->film[params->pixel_begin + item];
  for (uint i = 0; i < params->sample_count; ++i) {
    const uint path = item * params->sample_count + i;
    float4 radiance = vload4(path, g->path_radiance);
    if (!all(isfinite(radiance))) {
      radiance = (float4)(0.0f);
      atomic_inc(&g->counters[COUNTER_NOT_FINITE]);
    }
    const float3 xyz = xyz_from_spectrum(g, radiance, vload4(path, g->path_wavelengths), vload4(path, g->path_wavelength_pdfs));
    const float3 rgb = rgb_from_xyz(xyz);
    add_compensated(&film->xyz[0], &film->xyz_low[0], xyz.x);
    add_compensated(&film->xyz[1], &film->xyz_low[1], xyz.y);
    add_compensated(&film->xyz[2], &film->xyz_low[2], xyz.z);
    add_compensated(&film->rgb_squared[0], &film->rgb_squared_low[0], rgb.x * rgb.x);
    add_compensated(&film->rgb_squared[1], &film->rgb_squared_low[1], rgb.y * rgb.y);
    add_compensated(&film->rgb_squared[2], &film->rgb_squared_low[2], rgb.z * rgb.z);

    const float4 albedo = vload4(path, g->path_albedo);
    const float4 normal = vload4(path, g->path_normal);
    const float4 position = vload4(path, g->path_position);
    if (film->samples == 0) {
      film->object = as_uint(normal.w);
      film->primitive = as_uint(position.w);
    }
    film->samples += 1;
    if (as_uint(normal.w) != CAPLET_NONE) {
      film->hits += 1;
      film->depth += albedo.w;
      for (int k = 0; k < 3; ++k) {
        film->albedo[k] += k == 0 ? albedo.x : k == 1 ? albedo.y : albedo.z;
        film->normal[k] += k == 0 ? normal.x : k == 1 ? normal.y : normal.z;
        film->position[k] += k == 0 ? position.x : k == 1 ? position.y : position.z;
      }
    }
  }
}
#include "stages/kernel.cl"
