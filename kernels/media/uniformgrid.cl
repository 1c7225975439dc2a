// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This medium has one spectrum of coefficients and a density that varies; it may emit by
// temperature.
#ifndef CAPLET_MEDIA_UNIFORMGRID_CL
#define CAPLET_MEDIA_UNIFORMGRID_CL

#include "media/blackbody.cl"
#include "media/grid.cl"
#include "media/media_types.cl"

static inline MediumBox uniformgrid_medium_box(const MediumView* m) {
  MediumBox box;
  box.place = uniformgrid_medium_place(m->data);
  box.majorants = floats_from(m->grids, uniformgrid_medium_majorants(m->data));
  box.size = CAPLET_MAJORANT_CELLS;
  box.extinction = uniformgrid_medium_scale(m->data) *
                   (spectrum_eval(m->spectra, uniformgrid_medium_sigma_a(m->data), m->lambda) +
                    spectrum_eval(m->spectra, uniformgrid_medium_sigma_s(m->data), m->lambda));
  return box;
}

static inline MediumPoint uniformgrid_medium_at(const MediumView* m, float3 p, float3 q) {
  (void)p;
  __global const float* data = m->data;
  const int3 size = (int3)((int)uniformgrid_medium_nx(data), (int)uniformgrid_medium_ny(data),
                           (int)uniformgrid_medium_nz(data));
  const GridCells cells = grid_cells(size, q);
  const float density = uniformgrid_medium_scale(data) *
                        grid_value(&cells, floats_from(m->grids, uniformgrid_medium_density(data)));
  MediumPoint at;
  at.sigma_a = density * spectrum_eval(m->spectra, uniformgrid_medium_sigma_a(data), m->lambda);
  at.sigma_s = density * spectrum_eval(m->spectra, uniformgrid_medium_sigma_s(data), m->lambda);
  at.le = (float4)(0.0f);
  float glow = uniformgrid_medium_le_scale(data);
  if (!(glow > 0.0f)) return at;
  const uint scales = uniformgrid_medium_lescale(data), heat = uniformgrid_medium_temperature(data);
  if (scales != CAPLET_NONE) glow *= grid_value(&cells, floats_from(m->grids, scales));
  if (heat == CAPLET_NONE) {
    at.le = glow * spectrum_eval(m->spectra, uniformgrid_medium_le(data), m->lambda);
  } else {
    const float kelvin = grid_value(&cells, floats_from(m->grids, heat)) -
                         uniformgrid_medium_temperatureoffset(data);
    at.le = glow * blackbody_at(kelvin * uniformgrid_medium_temperaturescale(data), m->lambda);
  }
  return at;
}

#endif
