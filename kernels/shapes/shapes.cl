// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This file holds the shapes of the scene and the switch over them. Traversal has no code for
// shapes that the scene does not have.
#ifndef CAPLET_SHAPES_SHAPES_CL
#define CAPLET_SHAPES_SHAPES_CL

#include "shapes/csg.cl"
#include "shapes/spans.cl"

#define HIT_CASE(name, traits)                                              \
  case shape_##name:                                                        \
    if (HIT_IS_ASKED(traits)) return name##_hit(ray, block, lane, t, side); \
    break;
#define HIT_CASE_csg(traits) HIT_CASE(csg, traits)
#define HIT_CASE_instance(traits)

// Returns the lanes of the leaf block that the ray hits, where, and which side of which surface it
// sees. Rare shapes have rare_hit.
static inline real_mask shape_hit(uint shape, const ShapeRay* ray, __global const float* block,
                                  uint lane, real* t, real_mask* side) {
  switch (shape) {
#if CAPLET_REAL_WIDTH == 8
#define HIT_IS_ASKED(traits) 1
#else
#define HIT_IS_ASKED(traits) (((traits)&trait_rare) == 0)
#endif
#define SHAPE(name, traits) HIT_CASE(name, traits)
#define COMPOUND(name, traits) HIT_CASE_##name(traits)
#include "rows/shapes.def"
#undef SHAPE
#undef HIT_IS_ASKED
    default: break;
  }
  *t = real_of(0.0f);
  *side = int_of(0);
  return int_of(0);
}

#if CAPLET_REAL_WIDTH == 1
static inline int rare_hit(uint shape, const ShapeRay* ray, __global const float* block, uint lane,
                           float* t, int* side) {
  switch (shape) {
#define HIT_IS_ASKED(traits) (((traits)&trait_rare) != 0)
#define SHAPE(name, traits) HIT_CASE(name, traits)
#define COMPOUND(name, traits) HIT_CASE_##name(traits)
#include "rows/shapes.def"
#undef SHAPE
#undef HIT_IS_ASKED
    default: break;
  }
  *t = 0.0f;
  *side = 0;
  return 0;
}

static inline int shape_is_rare(uint shape) {
  switch (shape) {
#define SHAPE(name, traits) \
  case shape_##name:        \
    return ((traits)&trait_rare) != 0;
#include "rows/shapes.def"
#undef SHAPE
    default: return 0;
  }
}
#endif

// Does the same for every shape, rare ones too.
static inline real_mask any_shape_hit(uint shape, const ShapeRay* ray, __global const float* block,
                                      uint lane, real* t, real_mask* side) {
#if CAPLET_REAL_WIDTH == 1
  if (shape_is_rare(shape)) return rare_hit(shape, ray, block, lane, t, side);
#endif
  return shape_hit(shape, ray, block, lane, t, side);
}

#endif
