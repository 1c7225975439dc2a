// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// All shapes and the switch over them, which holds the cases of CAPLET_SHAPES alone (shared/shapes.h): what a scene does not have costs
// its traversal nothing.
#ifndef CAPLET_SHAPES_SHAPES_CL
#define CAPLET_SHAPES_SHAPES_CL

#include "shapes/csg.cl"
#include "shapes/spans.cl"

// Lanes of the leaf block that the ray hits, where, and which side of which surface it sees.
static inline real_mask shape_hit(uint shape, const ShapeRay* ray, __global const float* block, uint lane, real* t, real_mask* side) {
  switch (shape) {
#define SHAPE(name, traits)                                                            \
  case shape_##name:                                                                   \
    if (CAPLET_HAS_SHAPE(shape_##name)) return name##_hit(ray, block, lane, t, side); \
    break;
#define COMPOUND(name, traits)
#include "shared/shapes.def"
    SHAPE(csg, 0)
#undef SHAPE
    default: break;
  }
  *t = real_of(0.0f);
  *side = int_of(0);
  return int_of(0);
}

#endif
