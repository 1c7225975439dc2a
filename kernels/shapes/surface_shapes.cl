// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This file holds the switch over the surfaces of the shapes of the scene; csg shapes have those of
// their operands.
#ifndef CAPLET_SHAPES_SURFACE_SHAPES_CL
#define CAPLET_SHAPES_SURFACE_SHAPES_CL

#include "shapes/surface_local.cl"
#include "shapes/surface_{shapes}.cl"

// Returns the point (before ReverseOrientation) of a surface nearest to a point in its own space.
static inline LocalSurface surface_shape(uint shape, const SurfaceQuery* q) {
  switch (shape) {
#define SHAPE(name, traits) \
  case shape_##name:        \
    return surface_##name(q);
#define COMPOUND(name, traits)
#include "rows/shapes.def"
#undef SHAPE
    default: break;
  }
  const LocalSurface none = {q->x,           q->fallback,    q->fallback, (float3)(0.0f),
                             (float3)(0.0f), (float2)(0.0f), 0.0f,        0};
  return none;
}

#endif
