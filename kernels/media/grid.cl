// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Grids hold values at the centres of the cells of the unit cube; they are linear between them and
// 0 outside (Pharr, Jakob and Humphreys 2023, 11.4.3).
#ifndef CAPLET_MEDIA_GRID_CL
#define CAPLET_MEDIA_GRID_CL

#include "math/floats.cl"
#include "math/vector.cl"

// GridCells are the eight cells around a point, from the least in all coordinates on, x fastest:
// their numbers and weights; weights are 0 outside.
typedef struct {
  size_t cell[8];
  float weight[8];
} GridCells;

static inline GridCells grid_cells(int3 size, float3 q) {
  const float3 at = q * (float3)((float)size.x, (float)size.y, (float)size.z) - 0.5f;
  const float3 low = floor(at), part = at - low;
  const int3 first = (int3)((int)low.x, (int)low.y, (int)low.z);
  GridCells out;
  for (int i = 0; i < 8; ++i) {
    const int3 c = first + (int3)(i & 1, i >> 1 & 1, i >> 2);
    const int outside =
        c.x < 0 || c.y < 0 || c.z < 0 || c.x >= size.x || c.y >= size.y || c.z >= size.z;
    out.cell[i] =
        outside ? 0 : ((size_t)c.z * (size_t)size.y + (size_t)c.y) * (size_t)size.x + (size_t)c.x;
    const float x = (i & 1) != 0 ? part.x : 1.0f - part.x,
                y = (i & 2) != 0 ? part.y : 1.0f - part.y,
                z = (i & 4) != 0 ? part.z : 1.0f - part.z;
    out.weight[i] = outside ? 0.0f : x * y * z;
  }
  return out;
}

static inline float grid_value(const GridCells* cells, Floats values) {
  float sum = 0.0f;
  for (int i = 0; i < 8; ++i) sum += cells->weight[i] * *floats_at(values, cells->cell[i]);
  return sum;
}

#endif
