// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This medium has the densities of a NanoVDB file, and its temperatures.
#ifndef CAPLET_MEDIA_NANOVDB_CL
#define CAPLET_MEDIA_NANOVDB_CL

#include "media/blackbody.cl"
#include "media/media_types.cl"

static inline MediumBox nanovdb_medium_box(const MediumView* m) {
  MediumBox box;
  box.place = nanovdb_medium_place(m->data);
  box.majorants = floats_from(m->grids, nanovdb_medium_majorants(m->data));
  box.size = CAPLET_SPARSE_MAJORANT_CELLS;
  box.extinction = nanovdb_medium_scale(m->data) *
                   (spectrum_eval(m->spectra, nanovdb_medium_sigma_a(m->data), m->lambda) +
                    spectrum_eval(m->spectra, nanovdb_medium_sigma_s(m->data), m->lambda));
  return box;
}

// Returns a voxel of a grid of bricks of 8 x 8 x 8 voxels, x fastest (host/lower/sparse_grid.cpp).
// The grid is 12 floats of the matrix from the world to voxels; then as bits the first brick's
// coordinates, how many there are along each side, the float where their voxels begin, 0; and for
// each brick its number or CAPLET_NONE.
static inline float sparse_voxel(Floats values, int3 at) {
  __global const float* grid = floats_at(values, 0);
  const int3 low = (int3)(as_int(grid[12]), as_int(grid[13]), as_int(grid[14])),
             count = (int3)(as_int(grid[15]), as_int(grid[16]), as_int(grid[17]));
  const int3 brick = (int3)(at.x >> 3, at.y >> 3, at.z >> 3) - low;
  if (brick.x < 0 || brick.y < 0 || brick.z < 0 || brick.x >= count.x || brick.y >= count.y ||
      brick.z >= count.z)
    return 0.0f;
  const uint number = as_uint(*floats_at(
      values,
      20u + (((uint)brick.z * (uint)count.y + (uint)brick.y) * (uint)count.x + (uint)brick.x)));
  if (number == CAPLET_NONE) return 0.0f;
  return *floats_at(values, as_uint(grid[18]) + number * 512u +
                                (uint)(((at.z & 7) * 8 + (at.y & 7)) * 8 + (at.x & 7)));
}

// Values are at whole voxel coordinates, and linear between them.
static inline float sparse_value(Floats grid, float3 p) {
  const float3 at = clamp(transform_point(floats_at(grid, 0), p), -1e9f, 1e9f);
  const float3 low = floor(at), part = at - low;
  const int3 first = (int3)((int)low.x, (int)low.y, (int)low.z);
  float sum = 0.0f;
  for (int i = 0; i < 8; ++i) {
    const float x = (i & 1) != 0 ? part.x : 1.0f - part.x,
                y = (i & 2) != 0 ? part.y : 1.0f - part.y,
                z = (i & 4) != 0 ? part.z : 1.0f - part.z;
    const float weight = x * y * z;
    if (weight > 0.0f)
      sum += weight * sparse_voxel(grid, first + (int3)(i & 1, i >> 1 & 1, i >> 2));
  }
  return sum;
}

static inline MediumPoint nanovdb_medium_at(const MediumView* m, float3 p, float3 q) {
  (void)q;
  __global const float* data = m->data;
  const float density = nanovdb_medium_scale(data) *
                        sparse_value(floats_from(m->grids, nanovdb_medium_density(data)), p);
  MediumPoint at;
  at.sigma_a = density * spectrum_eval(m->spectra, nanovdb_medium_sigma_a(data), m->lambda);
  at.sigma_s = density * spectrum_eval(m->spectra, nanovdb_medium_sigma_s(data), m->lambda);
  at.le = (float4)(0.0f);
  const float glow = nanovdb_medium_le_scale(data);
  const uint heat = nanovdb_medium_temperature(data);
  if (heat == CAPLET_NONE || !(glow > 0.0f)) return at;
  const float kelvin =
      sparse_value(floats_from(m->grids, heat), p) - nanovdb_medium_temperatureoffset(data);
  at.le = glow * blackbody_at(kelvin * nanovdb_medium_temperaturescale(data), m->lambda);
  return at;
}

#endif
