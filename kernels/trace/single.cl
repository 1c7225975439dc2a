// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Finds the nearest, or any, hit of one ray in a tree of packed nodes.
#ifndef CAPLET_TRACE_SINGLE_CL
#define CAPLET_TRACE_SINGLE_CL

#include "trace/hits.cl"
#include "trace/walk.cl"

// Tests the lanes of a leaf of rare shapes. The state of the walk and the nearest hit so far wait
// in memory meanwhile, because compilers leave volatile values there.
static inline void rare_leaf(const Tree* tree, CAPLET_RAY_SPACE const RayRecord* ray, uint kind,
                             uint row, Walk* w, NearestHit* nearest) {
  __global const float* block = leaf_block(tree, row);
  volatile uint kept[8];
  kept[0] = w->top;
  kept[1] = w->bottom;
  kept[2] = w->floor;
  kept[3] = w->instance;
  kept[4] = as_uint(nearest->t);
  kept[5] = nearest->slot;
  kept[6] = nearest->instance;
  kept[7] = nearest->found ? (uint)nearest->side : CAPLET_NONE;
  const ShapeRay own = walk_ray(tree, ray, w->instance);
#pragma unroll 1
  for (uint lane = 0; lane < CAPLET_WIDTH && lanes_filled(block, lane) != 0; lane++) {
    float t;
    int side;
    if (rare_hit(kind, &own, block, lane, &t, &side) == 0) continue;
    NearestHit so_far = {as_float(kept[4]), kept[5], kept[6], (int)kept[7], kept[7] != CAPLET_NONE};
    keep_hits(tree, row * 8 + lane, &own, kept[3], -1, t, side, &so_far);
    if (!so_far.found) continue;
    kept[4] = as_uint(so_far.t);
    kept[5] = so_far.slot;
    kept[6] = so_far.instance;
    kept[7] = (uint)so_far.side;
  }
  w->top = kept[0];
  w->bottom = kept[1];
  w->floor = kept[2];
  w->instance = kept[3];
  nearest->t = as_float(kept[4]);
  nearest->slot = kept[5];
  nearest->instance = kept[6];
  nearest->side = (int)kept[7];
  nearest->found = kept[7] != CAPLET_NONE;
}

// Returns the closest hit in (t_min, t_max), or any hit nearer than `enough` (0: the closest;
// INFINITY: any). At equal t tie_is_before decides, so that the hit does not depend on the tree or
// on the order of traversal. Zero, infinite and NaN rays miss.
static inline HitRecord trace_ray_at(const Tree* tree, uint root,
                                     CAPLET_RAY_SPACE const RayRecord* ray, const float enough) {
  NearestHit nearest = nothing_before(ray->t_max);
  uint2 stack[CAPLET_WALK_ENTRIES];
  Walk walk;
  ShapeRay shape;
  if (!walk_begin(tree, ray, &walk, &shape, nearest.t)) return hit_record(&nearest);
  for (int visit = (int)root;; visit = -1) {
    const int leaf = walk_next(tree, root, ray, &walk, &shape, stack, nearest.t, visit);
    if (leaf == CAPLET_WALK_ENDS) return hit_record(&nearest);
    const uint kind = CAPLET_LEAF_KIND(leaf), row = CAPLET_LEAF_ROW(leaf);
    __global const float* block = leaf_block(tree, row);
    if (has_rare_shape && shape_is_rare(kind)) {
      walk_forget(&walk, stack);
      rare_leaf(tree, ray, kind, row, &walk, &nearest);
    } else {
#pragma unroll 1
      for (uint lane = 0; lane < CAPLET_WIDTH && leaf_lanes_filled(kind, block, lane) != 0; lane++)
        test_leaf(tree, kind, row, lane, &shape, walk.instance, &nearest);
    }
    if (nearest.found && nearest.t < enough) return hit_record(&nearest);
  }
}

#endif
