// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The shapes that there are and the switch over them: what a scene does not have costs its traversal nothing.
#ifndef CAPLET_SHAPES_SHAPES_CL
#define CAPLET_SHAPES_SHAPES_CL

#include "shapes/csg.cl"
#include "shapes/spans.cl"

// Of shapes that are rare or of those that are not; eight lanes are tested of either alike.
static inline real_mask hit_among(uint shape, const int rare, const ShapeRay* ray, __global const float* block, uint lane, real* t,
                                  real_mask* side) {
  switch (shape) {
#define SHAPE(name, traits)                                                            \
  case shape_##name:                                                                   \
    if (CAPLET_REAL_WIDTH == 8 || (((traits)&trait_rare) != 0) == rare) return name##_hit(ray, block, lane, t, side); \
    break;
#define COMPOUND(name, traits) COMPOUND_CASE_##name(traits)
#define COMPOUND_CASE_csg(traits) SHAPE(csg, traits)
#define COMPOUND_CASE_instance(traits)
#include "rows/shapes.def"
#undef SHAPE
    default: break;
  }
  *t = real_of(0.0f);
  *side = int_of(0);
  return int_of(0);
}

// Lanes of the leaf block that the ray hits, where, and which side of which surface it sees. Of rare shapes: rare_hit.
static inline real_mask shape_hit(uint shape, const ShapeRay* ray, __global const float* block, uint lane, real* t, real_mask* side) {
  return hit_among(shape, 0, ray, block, lane, t, side);
}

#if CAPLET_REAL_WIDTH == 1
static inline int rare_hit(uint shape, const ShapeRay* ray, __global const float* block, uint lane, float* t, int* side) {
  return hit_among(shape, 1, ray, block, lane, t, side);
}

static inline int shape_is_rare(uint shape) {
  switch (shape) {
#define SHAPE(name, traits) \
  case shape_##name: return ((traits)&trait_rare) != 0;
#include "rows/shapes.def"
#undef SHAPE
    default: return 0;
  }
}
#endif

#endif
