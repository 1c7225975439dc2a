// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The shapes that there are and the switch over them: what a scene does not have costs its traversal nothing.
#ifndef CAPLET_SHAPES_SHAPES_CL
#define CAPLET_SHAPES_SHAPES_CL

#include "shapes/csg.cl"
#include "shapes/spans.cl"

// Lanes of the leaf block that the ray hits, where, and which side of which surface it sees.
static inline real_mask shape_hit(uint shape, const ShapeRay* ray, __global const float* block, uint lane, real* t, real_mask* side) {
  switch (shape) {
#define SHAPE(name, traits) \
  case shape_##name: return name##_hit(ray, block, lane, t, side);
#define COMPOUND(name, traits) COMPOUND_CASE_##name
#define COMPOUND_CASE_csg SHAPE(csg, 0)
#define COMPOUND_CASE_instance
#include "rows/shapes.def"
#undef SHAPE
    default: break;
  }
  *t = real_of(0.0f);
  *side = int_of(0);
  return int_of(0);
}

#endif
