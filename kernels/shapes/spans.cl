// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This file holds the spans of the shapes of the scene, csg aside, and the switches over them.
#ifndef CAPLET_SHAPES_SPANS_CL
#define CAPLET_SHAPES_SPANS_CL

#include "shapes/lanes.cl"
#include "shapes/traits.cl"
#include "shapes/{shapes}.cl"

#define SHAPE(name, traits)                                          \
  case shape_##name:                                                 \
    if (SPAN_IS_ASKED(traits)) return name##_span(ray, block, lane); \
    break;

// Returns the crossings of the lanes of a block with the ray's line. csg shapes have any number of
// them and are not handled here.
static inline Span shape_span(uint shape, const ShapeRay* ray, __global const float* block,
                              uint lane) {
  switch (shape) {
#define COMPOUND(name, traits)
#define SPAN_IS_ASKED(traits) 1
#include "rows/shapes.def"
#undef SPAN_IS_ASKED
    default: break;
  }
  return span_of(int_of(0), real_of(0.0f), real_of(0.0f));
}

// Does the same for solids alone, which csg shapes combine.
static inline Span solid_span(uint shape, const ShapeRay* ray, __global const float* block,
                              uint lane) {
  switch (shape) {
#define COMPOUND(name, traits)
#define SPAN_IS_ASKED(traits) (((traits)&trait_solid) != 0)
#include "rows/shapes.def"
#undef SPAN_IS_ASKED
    default: break;
  }
  return span_of(int_of(0), real_of(0.0f), real_of(0.0f));
}
#undef SHAPE

#endif
