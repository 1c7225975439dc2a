// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Finds the hits of a ray with a leaf block, and decides which of two hits counts.
#ifndef CAPLET_TRACE_HITS_CL
#define CAPLET_TRACE_HITS_CL

#include "groups.cl"
#include "math/vector.cl"
#include "shapes/placed.cl"
#include "shapes/shapes.cl"
#include "slots.cl"

// With zero, infinite and NaN rays traversal would follow children that do not exist.
static inline int line_is_valid(float3 o, float3 d) {
  const float dd = dot(d, d), oo = fabs(o.x) + fabs(o.y) + fabs(o.z);
  return dd > 0.0f && dd < INFINITY && oo < INFINITY;
}

// Says which of two hits at the same t counts: hits of the world's shapes come before those of the
// scene's instances, these in their order, then the smaller primitive comes first. So the hit does
// not depend on slots, or on how trees were built. The records are read at ties alone.
static inline int tie_is_before(const Tree* tree, uint slot, uint instance, uint other_slot,
                                uint other_instance) {
  if (CAPLET_HAS_SHAPE(shape_instance) && instance != other_instance) {
    // Trees of world shapes have no object number: CAPLET_NONE + 1 is 0.
    const uint object = instance == CAPLET_NONE ? 0u : tree->instances[instance].object + 1u;
    const uint other =
        other_instance == CAPLET_NONE ? 0u : tree->instances[other_instance].object + 1u;
    if (object != other) return object < other;
  }
  const uint primitive = primitive_at(tree, slot), other_primitive = primitive_at(tree, other_slot);
  if (primitive != other_primitive) return primitive < other_primitive;
  return instance < other_instance;
}

// NearestHit is the nearest hit found so far, or, where there is none, how far a ray goes: a hit at
// exactly its end is none.
typedef struct {
  float t;
  uint slot, instance;
  int side, found;
} NearestHit;

static inline NearestHit nothing_before(float t_max) {
  const NearestHit nothing = {fmin(t_max, MAXFLOAT), 0, CAPLET_NONE, 0, 0};
  return nothing;
}

static inline HitRecord hit_record(const NearestHit* nearest) {
  HitRecord hit = {INFINITY, CAPLET_NONE, CAPLET_NONE, 0};
  if (nearest->found) {
    hit.t = nearest->t;
    hit.slot = nearest->slot;
    hit.instance = nearest->instance;
    hit.surface = (uint)nearest->side;
  }
  return hit;
}

// Returns the lanes of a leaf block that hold a primitive: they are filled from the first on.
static inline real_mask leaf_lanes_filled(uint kind, __global const float* block, uint lane) {
#ifdef CAPLET_SHAPES_LINKED_CAPSULE_CL
  if (kind_is_linked(kind)) return links_filled(block, lane);
#endif
  (void)kind;
  return lanes_filled(block, lane);
}

#ifdef CAPLET_SHAPES_CAPSULE_CL
// Returns 0 where the ray hits none of a leaf block's primitives in [t_min, t_max], as far as their
// kind can tell at less cost than its test.
static inline int leaf_may_hit(uint kind, const NearRay* ray, __global const float* block,
                               float t_min, float t_max) {
  if (CAPLET_HAS_SHAPE(shape_capsule) && kind == shape_capsule)
    return mask_bits(capsule_near(ray, block, 0, t_min, t_max) & lanes_filled(block, 0)) != 0;
#ifdef CAPLET_SHAPES_LINKED_CAPSULE_CL
  if (kind_is_linked(kind))
    return mask_bits(linked_capsule_near(ray, block, 0, t_min, t_max) & links_filled(block, 0)) !=
           0;
#endif
  return 1;
}
#endif

// Keeps the nearest of the ray's hits with the primitives from slot `first` on. `ok`: the lanes
// that are hit and filled; `instance`: that the ray is in.
static inline void keep_hits(const Tree* tree, uint first, const ShapeRay* shape, uint instance,
                             real_mask ok, real t, real_mask side, NearestHit* nearest) {
  ok &= (t > shape->t_min) & (t <= nearest->t);
  // These are tested one by one: PoCL 6.0 aborts where the two are chosen between by the side
  // (docs/drivers.md).
  if (shape->sees_entering == 0) ok &= (side & int_of(CAPLET_LEAVING)) != 0;
  if (shape->sees_leaving == 0) ok &= (side & int_of(CAPLET_LEAVING)) == 0;
  uint bits = mask_bits(ok);
  if (bits == 0) return;
  float ts[CAPLET_REAL_WIDTH];
  real_store(t, ts);
  int sides[CAPLET_REAL_WIDTH];
  mask_store(side, sides);
  do {
    const uint i = lowest_bit(bits);
    bits &= bits - 1;
    const uint slot = first + i;
    if (ts[i] < nearest->t ||
        (ts[i] == nearest->t && nearest->found &&
         tie_is_before(tree, slot, instance, nearest->slot, nearest->instance))) {
      nearest->t = ts[i];
      nearest->slot = slot;
      nearest->instance = instance;
      nearest->side = sides[i];
      nearest->found = 1;
    }
  } while (bits != 0);
}

// Tests the ray with these lanes, whose shapes are of one kind, and not rare where it is traced
// alone.
static inline void test_leaf(const Tree* tree, uint kind, uint row, uint lane,
                             const ShapeRay* shape, uint instance, NearestHit* nearest) {
  real t;
  real_mask side;
  __global const float* block = leaf_block(tree, row);
  const real_mask ok =
      shape_hit(kind, shape, block, lane, &t, &side) & leaf_lanes_filled(kind, block, lane);
  keep_hits(tree, leaf_slot(kind, row, lane), shape, instance, ok, t, side, nearest);
}

#endif
