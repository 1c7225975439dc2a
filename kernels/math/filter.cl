// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Samples the pixel filter by importance (Ernst, Stamminger and Greiner, "Filter importance
// sampling", 2006). Every filter is a product of one function an axis, each piecewise linear over
// the cells of a table (host/lower/filter.cpp).
#ifndef CAPLET_MATH_FILTER_CL
#define CAPLET_MATH_FILTER_CL

#include "math/vector.cl"

// Returns t in [0, 1] with density proportional to the line from a at 0 to b at 1 (a, b >= 0, not
// both 0).
static inline float sample_linear(float u, float a, float b) {
  const float root = sqrt(a * a + u * (b * b - a * a));
  return u > 0.0f ? fmin(u * (a + b) / (a + root), 1.0f) : 0.0f;
}

// Samples one axis: `table` holds cells + 1 positions, cells + 1 values of the running integral of
// |f| (0 to 1), cells + 1 signed values of f, and the integral of |f| over the integral of f.
static inline float filter_axis(__global const float* table, uint cells, float u, float* weight) {
  __global const float* positions = table;
  __global const float* integral = table + cells + 1;
  __global const float* values = table + 2 * (cells + 1);
  uint low = 0, high = cells - 1;
  while (low < high) {
    const uint middle = (low + high + 1) / 2;
    if (integral[middle] <= u)
      low = middle;
    else
      high = middle - 1;
  }
  const float begin = integral[low], width = integral[low + 1] - begin;
  const float within = width > 0.0f ? clamp((u - begin) / width, 0.0f, 1.0f) : 0.5f;
  const float a = values[low], b = values[low + 1];
  *weight *= a + b < 0.0f ? -table[3 * (cells + 1)] : table[3 * (cells + 1)];
  return mix(positions[low], positions[low + 1], sample_linear(within, fabs(a), fabs(b)));
}

// Returns the offset from the pixel's centre, in pixels, for u in [0, 1)^2, by a table of width and
// height cells an axis. *weight is the weight of the sample: 1 for filters that are nowhere
// negative, otherwise plus or minus a constant, 1 on average.
static inline float2 filter_sample(__global const float* table, uint width, uint height, float2 u,
                                   float* weight) {
  *weight = 1.0f;
  const float x = filter_axis(table, width, u.x, weight);
  const float y = filter_axis(table + 3 * (width + 1) + 1, height, u.y, weight);
  return (float2)(x, y);
}

#endif
