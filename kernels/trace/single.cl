// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The nearest, or any, hit of one ray in a tree of packed nodes.
#ifndef CAPLET_TRACE_SINGLE_CL
#define CAPLET_TRACE_SINGLE_CL

#include "trace/hits.cl"
#include "trace/walk.cl"

// Closest hit in (t_min, t_max), or, with `any`, the first one found. Equal t: tie_is_before, so that neither the tree nor the order of
// traversal can show. Zero, infinite and NaN rays miss.
static inline HitRecord trace_ray_at(const Tree* tree, uint root, CAPLET_RAY_SPACE const RayRecord* ray, const int any) {
  NearestHit nearest = nothing_before(ray->t_max);
  uint2 stack[CAPLET_WALK_ENTRIES];
  Walk walk;
  ShapeRay shape;
  if (!walk_begin(tree, ray, &walk, &shape, nearest.t)) return hit_record(&nearest);
  for (int visit = (int)root;; visit = -1) {
    const int leaf = walk_next(tree, root, ray, &walk, &shape, stack, nearest.t, visit);
    if (leaf == CAPLET_WALK_ENDS) return hit_record(&nearest);
    const uint kind = CAPLET_LEAF_KIND(leaf), row = CAPLET_LEAF_ROW(leaf);
    // Lanes are filled from the first on.
#pragma unroll 1
    for (uint lane = 0; lane < CAPLET_WIDTH && lanes_filled(tree->leaves + (size_t)row * 8, lane) != 0; lane++)
      test_leaf(tree, kind, row, lane, &shape, walk.instance, &nearest);
    if (any && nearest.found) return hit_record(&nearest);
  }
}

#endif
