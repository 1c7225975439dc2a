// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The spans of all shapes but csg, and the switches over them.
#ifndef CAPLET_SHAPES_SPANS_CL
#define CAPLET_SHAPES_SPANS_CL

#include "shapes/bilinear.cl"
#include "shapes/box.cl"
#include "shapes/capsule.cl"
#include "shapes/cone.cl"
#include "shapes/cylinder.cl"
#include "shapes/disk.cl"
#include "shapes/open_cylinder.cl"
#include "shapes/partial_disk.cl"
#include "shapes/partial_sphere.cl"
#include "shapes/polyhedron.cl"
#include "shapes/sphere.cl"
#include "shapes/tapered_capsule.cl"
#include "shapes/triangle.cl"

#define COMPOUND(name, traits)
#define SHAPE(name, traits)                                                           \
  case shape_##name:                                                                  \
    if (SPAN_IS_ASKED(shape_##name, traits)) return name##_span(ray, block, lane); \
    break;

// The crossings of the lanes of a block with the ray's line; not for csg shapes, which have any number of them.
static inline Span shape_span(uint shape, const ShapeRay* ray, __global const float* block, uint lane) {
  switch (shape) {
#define SPAN_IS_ASKED(kind, traits) CAPLET_HAS_SHAPE(kind)
#include "shared/shapes.def"
#undef SPAN_IS_ASKED
    default: break;
  }
  return span_of(int_of(0), real_of(0.0f), real_of(0.0f));
}

// The same of solids alone: what csg shapes combine.
static inline Span solid_span(uint shape, const ShapeRay* ray, __global const float* block, uint lane) {
  switch (shape) {
#define COMPOUND(name, traits)
#define SPAN_IS_ASKED(kind, traits) (CAPLET_HAS_SHAPE(kind) && ((traits)&trait_solid) != 0)
#include "shared/shapes.def"
#undef SPAN_IS_ASKED
    default: break;
  }
  return span_of(int_of(0), real_of(0.0f), real_of(0.0f));
}
#undef SHAPE

// Whether all that a line does to shapes of this kind is one span.
static inline int shape_is_solid(uint shape) {
  switch (shape) {
#define SHAPE(name, traits) \
  case shape_##name: return ((traits)&trait_solid) != 0;
#include "shared/shapes.def"
#undef SHAPE
    default: return 0;
  }
}

#endif
