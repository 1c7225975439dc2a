// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This medium has coefficients of any colour, cell by cell: spectra are interpolated, not colours.
#ifndef CAPLET_MEDIA_RGBGRID_CL
#define CAPLET_MEDIA_RGBGRID_CL

#include "media/grid.cl"
#include "media/media_types.cl"

static inline MediumBox rgbgrid_medium_box(const MediumView* m) {
  MediumBox box;
  box.place = rgbgrid_medium_place(m->data);
  box.majorants = floats_from(m->grids, rgbgrid_medium_majorants(m->data));
  box.size = CAPLET_MAJORANT_CELLS;
  box.extinction = (float4)(rgbgrid_medium_scale(m->data));
  return box;
}

static inline float4 rgbgrid_value(const MediumView* m, const GridCells* cells, uint grid) {
  float4 sum = (float4)(0.0f);
  for (int i = 0; i < 8; ++i) {
    if (!(cells->weight[i] > 0.0f)) continue;
    const float4 texel = vload4(0, floats_at(m->grids, grid + 4 * cells->cell[i]));
    sum += cells->weight[i] * texel.w * sigmoid_polynomial(texel.x, texel.y, texel.z, m->lambda);
  }
  return sum;
}

static inline MediumPoint rgbgrid_medium_at(const MediumView* m, float3 p, float3 q) {
  (void)p;
  __global const float* data = m->data;
  const int3 size = (int3)((int)rgbgrid_medium_nx(data), (int)rgbgrid_medium_ny(data),
                           (int)rgbgrid_medium_nz(data));
  const GridCells cells = grid_cells(size, q);
  const float scale = rgbgrid_medium_scale(data), glow = rgbgrid_medium_le_scale(data);
  const uint a = rgbgrid_medium_sigma_a(data), s = rgbgrid_medium_sigma_s(data),
             le = rgbgrid_medium_le(data);
  MediumPoint at;
  at.sigma_a = a == CAPLET_NONE ? (float4)(scale) : scale * rgbgrid_value(m, &cells, a);
  at.sigma_s = s == CAPLET_NONE ? (float4)(scale) : scale * rgbgrid_value(m, &cells, s);
  at.le = (float4)(0.0f);
  if (le != CAPLET_NONE && glow > 0.0f)
    at.le = glow * rgbgrid_value(m, &cells, le) *
            spectrum_table_at4(m->spectra->spectrum_tables + rgbgrid_medium_illuminant(data),
                               m->lambda);
  return at;
}

#endif
