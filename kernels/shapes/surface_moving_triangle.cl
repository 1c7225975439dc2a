// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Computes the surface of a triangle whose vertices and normals change with time: at one time it is
// that of a triangle.
#ifndef CAPLET_SHAPES_SURFACE_MOVING_TRIANGLE_CL
#define CAPLET_SHAPES_SURFACE_MOVING_TRIANGLE_CL

#include "shapes/moving_corners.cl"
#include "shapes/surface_triangle.cl"

static inline LocalSurface surface_moving_triangle(const SurfaceQuery* q) {
  const uint stride = moving_triangle_stride(q->data);
  const KeyPair keys =
      triangle_keys(q->leaves, moving_triangle_begin(q->data), moving_triangle_times(q->data),
                    moving_triangle_segments(q->data), stride, q->time);
  Barycentric at;
  LocalSurface s = triangle_point(q, vector_between_keys(keys, 0u), vector_between_keys(keys, 3u),
                                  vector_between_keys(keys, 6u), &at);
  if (stride > 9u) {
    const float3 none = (float3)(0.0f);
    s.ns = triangle_shading_normal(at, unit_or(vector_between_keys(keys, 9u), none),
                                   unit_or(vector_between_keys(keys, 12u), none),
                                   unit_or(vector_between_keys(keys, 15u), none), s.ng);
  }
  return s;
}

#endif
