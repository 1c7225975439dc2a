// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The switch over the surfaces of all shapes but csg, whose surfaces are its operands'.
#ifndef CAPLET_SHAPES_SURFACE_SHAPES_CL
#define CAPLET_SHAPES_SURFACE_SHAPES_CL

#include "shapes/surface_bilinear.cl"
#include "shapes/surface_box.cl"
#include "shapes/surface_capsule.cl"
#include "shapes/surface_cone.cl"
#include "shapes/surface_cylinder.cl"
#include "shapes/surface_disk.cl"
#include "shapes/surface_open_cylinder.cl"
#include "shapes/surface_partial_disk.cl"
#include "shapes/surface_partial_sphere.cl"
#include "shapes/surface_polyhedron.cl"
#include "shapes/surface_sphere.cl"
#include "shapes/surface_tapered_capsule.cl"
#include "shapes/surface_triangle.cl"

// The point (before ReverseOrientation) of a surface nearest to a point in its own space.
static inline LocalSurface surface_shape(uint shape, const SurfaceQuery* q) {
  switch (shape) {
#define SHAPE(name, traits)                                        \
  case shape_##name:                                               \
    if (CAPLET_HAS_SHAPE(shape_##name)) return surface_##name(q); \
    break;
#define COMPOUND(name, traits)
#include "shared/shapes.def"
#undef SHAPE
    default: break;
  }
  const LocalSurface none = {q->x, q->fallback, q->fallback, (float3)(0.0f), (float3)(0.0f), (float2)(0.0f), 0.0f};
  return none;
}

#endif
