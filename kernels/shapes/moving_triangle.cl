// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Tests a triangle whose vertices change with time. At the ray's time it is a triangle, and its
// hits are those of that triangle to the bit.
#ifndef CAPLET_SHAPES_MOVING_TRIANGLE_CL
#define CAPLET_SHAPES_MOVING_TRIANGLE_CL

#include "shapes/moving_corners.cl"
#include "shapes/triangle.cl"

static inline KeyPair moving_triangle_keys(const ShapeRay* ray, __global const float* block,
                                           uint lane) {
  __global const float* of = lane_data(block, lane);
  return triangle_keys(ray->leaves, moving_triangle_begin(of), moving_triangle_times(of),
                       moving_triangle_segments(of), moving_triangle_stride(of), ray_time(ray));
}

static inline real_mask moving_triangle_hit(const ShapeRay* ray, __global const float* block,
                                            uint lane, real* t, real_mask* side) {
  const TriangleRay axes = triangle_ray_of(ray);
  const uint order[3] = {axes.row_x / 8u, axes.row_y / 8u, axes.row_z / 8u};
  real numbers[9];  // of the three vertices, in the order of the ray's axes
#if CAPLET_REAL_WIDTH == 8
  (void)lane;
  float data[9][8];
  for (uint i = 0; i < 8u; i++) {
    const KeyPair keys = moving_triangle_keys(ray, block, i);
    for (uint k = 0; k < 9u; k++) data[k][i] = between_keys(keys, k / 3u * 3u + order[k % 3u]);
  }
  for (uint k = 0; k < 9u; k++) numbers[k] = vload8(0, data[k]);
#else
  const KeyPair keys = moving_triangle_keys(ray, block, lane);
  for (uint k = 0; k < 9u; k++) numbers[k] = between_keys(keys, k / 3u * 3u + order[k % 3u]);
#endif
  return triangle_hit_of(&axes, triangle_vertex(&axes, numbers[0], numbers[1], numbers[2]),
                         triangle_vertex(&axes, numbers[3], numbers[4], numbers[5]),
                         triangle_vertex(&axes, numbers[6], numbers[7], numbers[8]), t, side);
}

static inline Span moving_triangle_span(const ShapeRay* ray, __global const float* block,
                                        uint lane) {
  real t;
  real_mask side;
  const real_mask hit = moving_triangle_hit(ray, block, lane, &t, &side);
  return span_of_one(hit, t, side);
}

#endif
