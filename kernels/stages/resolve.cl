// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Finished paths to the film: one work-item a pixel adds its samples in order with compensated sums (Kahan 1965), so that how
// samples were split into batches cannot change a bit, and that a million of them lose nothing.
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

static void stage_item(const Stage* g, uint item) {
  __global const BatchRecord* batch = g->batch.batch;
  __global const ViewRecord* view = g->view.view;
  const uint pixel = batch->pixel_begin + item;
  const uint x = batch->window_x + pixel % batch->window_width, y = batch->window_y + pixel / batch->window_width;
  const uint place = (y - view->crop_y) * view->crop_width + (x - view->crop_x);
  FilmRecord film = g->film.film[place];
  for (uint i = 0; i < batch->sample_count; ++i) {
    const uint path = item * batch->sample_count + i;
    const float4 radiance = g->radiance.path_radiance[path];
    float3 xyz = xyz_from_spectrum(g->observer.observer, radiance, g->carried.path_wavelengths[path],
                                   g->carried.path_wavelength_pdfs[path]);
    if (!all(isfinite(radiance)) || !all(isfinite(xyz))) {
      xyz = (float3)(0.0f);
      atomic_inc(&g->counters.counters[counter_not_finite]);
    }
    const float3 rgb = rgb_from_xyz(view->rgb_from_xyz, xyz);
    add_compensated3(film.xyz, film.xyz_low, xyz);
    add_compensated3(film.rgb_squared, film.rgb_squared_low, rgb * rgb);

    const FirstHitRecord hit = g->first_hit.path_first_hit[path];
    if (film.samples == 0) {
      film.object = hit.object;
      film.primitive = hit.primitive;
    }
    film.samples += 1;
    if (hit.object != CAPLET_NONE) {
      film.hits += 1;
      add_compensated3(film.albedo, film.albedo_low, vload3(0, hit.albedo));
      add_compensated3(film.normal, film.normal_low, vload3(0, hit.normal));
      add_compensated3(film.position, film.position_low, vload3(0, hit.position));
      add_compensated(&film.depth, &film.depth_low, hit.depth);
    }
  }
  g->film.film[place] = film;
}
