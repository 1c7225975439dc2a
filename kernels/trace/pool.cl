// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Traces many rays of one work-item at a time, for processors with eight lanes: the waits of the
// rays in the pool (for memory, for a branch) overlap. A round is three tight loops: over the rays
// at nodes, over those at leaves, and over all of them to go on. Hits are those of trace_ray to the
// bit, because the hit does not depend on the order of traversal or of tests.
//
// The including file defines what many.cl lists.
#ifndef CAPLET_TRACE_POOL_CL
#define CAPLET_TRACE_POOL_CL

#include "trace/eight.cl"
#include "trace/trace.cl"

#ifndef CAPLET_POOL_RAYS
#define CAPLET_POOL_RAYS 24
#endif
// This is the number of nodes on the longest path, both levels of trees together.
#ifndef CAPLET_PATH_NODES
#define CAPLET_PATH_NODES (2 * CAPLET_TREE_DEPTH_MAX)
#endif
// Each node on the path leaves seven children, and the last one writes eight places; there is one
// entry at the bottom, and one that leaves an instance.
#define CAPLET_POOL_STACK (7 * CAPLET_PATH_NODES + 8 + 2)
#define CAPLET_POOL_LEAVE_INSTANCE 0x7fffffff  // a child: the ray goes back to the world

// A child is a node or a leaf, with the parameter where the ray enters its box: not negative, so
// its bits order as it does.
typedef struct {
  SlabRay slab;
  ShapeRay shape;
  NearRay near;
  NearestHit nearest;
  float t_min;
#if TRACED_MAY_END_EARLY
  float enough;
#endif
  uint instance;  // that the ray is in
  uint item;
  int flip;  // the octant of the direction: bit k where it falls along axis k
  int current, top;
  int enter[CAPLET_POOL_STACK], child[CAPLET_POOL_STACK];
} PooledRay;

static inline int octant_of(const SlabRay* s) {
  return (s->near_x != 0 ? 1 : 0) | (s->near_y != 8 ? 2 : 0) | (s->near_z != 16 ? 4 : 0);
}

// Sets up the ray of `r->item` as it is in the world.
static inline void pool_ray(PooledRay* r, const Stage* g, const Tree* tree, float3 o, float3 d) {
  const Tree then = tree_at(tree, TRACED_TIME(g, r->item));
  r->instance = CAPLET_NONE;
  r->slab = slab_ray(o, d);
  r->shape = shape_ray_of(&then, o, d, r->t_min);
  r->near = near_ray(o, d);
  r->flip = octant_of(&r->slab);
}

// Returns 0 if the ray can hit nothing.
static inline int pool_begin(PooledRay* r, const Stage* g, const Tree* tree, uint root, uint item) {
  const RayRecord ray = traced_ray(g, item);
  const float3 o = (float3)(ray.ox, ray.oy, ray.oz), d = (float3)(ray.dx, ray.dy, ray.dz);
  r->item = item;
#if TRACED_MAY_END_EARLY
  r->enough = TRACED_ENOUGH(g, item);
#endif
  r->t_min = ray.t_min > 0.0f ? ray.t_min : 0.0f;  // never -0: stack entries go by the bits
  r->nearest = nothing_before(ray.t_max);
  pool_ray(r, g, tree, o, d);
  r->current = (int)root;
  r->enter[0] = -1;  // ends every search for the next entry
  r->child[0] = 0;
  r->top = 1;
  return line_is_valid(o, d) && ray.t_min < ray.t_max && r->t_min < r->nearest.t;
}

// Puts the children of a node that the ray meets on its stack, nearest on top by the octant that
// they lie in.
static inline void pool_visit(PooledRay* r, Floats nodes) {
  __global const float* node = node_at(nodes, (uint)r->current);
  float8 near;
  const int8 boxes = boxes_met(node, &r->slab, r->t_min, r->nearest.t, &near);
  // Slot k holds the child that lies furthest along the octant k: seen along the ray they come in
  // the order of k ^ flip.
  const int8 lanes = (int8)(0, 1, 2, 3, 4, 5, 6, 7) ^ (int8)(r->flip);
  const uint met = mask_bits(permuted(boxes, lanes));
  const int8 order = convert_int8(as_uchar8(set_bits[met])) ^ (int8)(r->flip);
  vstore8(permuted(as_int8(near), order), 0, r->enter + r->top);
  vstore8(permuted(vload8(0, (__global const int*)(node + CAPLET_NODE_CHILDREN)), order), 0,
          r->child + r->top);
  r->top += (int)popcount(met);
}

// Moves the ray into the instance that it is at. Below the entries of the instance's root lies one
// that leads back.
static inline void pool_enter_instance(PooledRay* r, const Stage* g, const Tree* tree) {
  const uint instance = ((__global const uint*)leaf_block(tree, CAPLET_LEAF_ROW(r->current)))[0];
  const Tree then = tree_at(tree, TRACED_TIME(g, r->item));
  const RayRecord ray = traced_ray(g, r->item);
  r->instance = instance;
  r->enter[r->top] = 0;
  r->child[r->top++] = CAPLET_POOL_LEAVE_INSTANCE;
  const int valid =
      ray_to_instance(&then, instance, (float3)(ray.ox, ray.oy, ray.oz),
                      (float3)(ray.dx, ray.dy, ray.dz), r->t_min, &r->slab, &r->shape);
  r->near = near_ray((float3)(r->shape.ox, r->shape.oy, r->shape.oz),
                     (float3)(r->shape.dx, r->shape.dy, r->shape.dz));
  r->flip = octant_of(&r->slab);
  if (!valid) return;
  r->enter[r->top] = 0;
  r->child[r->top++] = (int)instance_root(&then, instance);
}

static inline void pool_leave_instance(PooledRay* r, const Stage* g, const Tree* tree) {
  const RayRecord ray = traced_ray(g, r->item);
  pool_ray(r, g, tree, (float3)(ray.ox, ray.oy, ray.oz), (float3)(ray.dx, ray.dy, ray.dz));
}

// Begins with the first ray of [*next, end) that may hit something, and reports those before it as
// misses. Returns 0 if there is none.
static inline int pool_begin_next(PooledRay* r, const Stage* g, uint* next, uint end) {
  const HitRecord miss = {INFINITY, CAPLET_NONE, CAPLET_NONE, 0};
  for (; *next < end; traced_hit(g, (*next)++, &miss))
    if (pool_begin(r, g, TRACED_TREE(g), TRACED_ROOT(g, *next), *next)) {
      (*next)++;
      return 1;
    }
  return 0;
}

// Returns the place in the ray's stack of what it visits next, or 0 when it is done.
static inline int pool_pop(PooledRay* r, const Stage* g, const Tree* tree) {
  int top = r->top;
#if TRACED_MAY_END_EARLY
  if (r->nearest.found && r->nearest.t < r->enough) top = 1;
#endif
  for (;;) {
    const int t_best = as_int(r->nearest.t);
    do top--;
    while (r->enter[top] > t_best);
    if (!CAPLET_HAS_SHAPE(shape_instance) || top == 0 ||
        r->child[top] != CAPLET_POOL_LEAVE_INSTANCE)
      return top;
    pool_leave_instance(r, g, tree);
  }
}

// Traces rays [next, end).
static void trace_pool(const Stage* g, uint next, const uint end) {
  const Tree* tree = TRACED_TREE(g);
  PooledRay pool[CAPLET_POOL_RAYS];
  // These are places in the pool; each list has one more, which is written and not kept.
  uchar at_node[CAPLET_POOL_RAYS + 1], at_leaf[CAPLET_POOL_RAYS + 1],
      going_on[CAPLET_POOL_RAYS + 1];
  int nodes = 0, leaves = 0;

  for (uint place = 0; place < CAPLET_POOL_RAYS; place++) {
    if (pool_begin_next(&pool[place], g, &next, end)) at_node[nodes++] = (uchar)place;
  }
  while (nodes + leaves > 0) {
    int count = 0;
    for (int i = 0; i < nodes; i++) {
      pool_visit(&pool[at_node[i]], nodes_of(tree));
      going_on[count++] = at_node[i];
    }
#ifdef CAPLET_SHAPES_CAPSULE_CL
    int near = 0;
    for (int i = 0; i < leaves; i++) {
      const uchar place = at_leaf[i];
      const PooledRay* r = &pool[place];
      const int may =
          leaf_may_hit(CAPLET_LEAF_KIND(r->current), &r->near,
                       leaf_block(tree, CAPLET_LEAF_ROW(r->current)), r->t_min, r->nearest.t);
      at_leaf[near] = place;
      going_on[count] = place;
      near += may;
      count += 1 - may;
    }
    leaves = near;
#endif
    for (int i = 0; i < leaves; i++) {
      PooledRay* r = &pool[at_leaf[i]];
      if (CAPLET_HAS_SHAPE(shape_instance) && CAPLET_LEAF_KIND(r->current) == shape_instance)
        pool_enter_instance(r, g, tree);
      else
        test_leaf(tree, CAPLET_LEAF_KIND(r->current), CAPLET_LEAF_ROW(r->current), 0, &r->shape,
                  r->instance, &r->nearest);
      going_on[count++] = at_leaf[i];
    }
    nodes = leaves = 0;
    for (int i = 0; i < count; i++) {
      const uchar place = going_on[i];
      PooledRay* r = &pool[place];
      const int top = pool_pop(r, g, tree);
      if (top == 0) {
        const HitRecord hit = hit_record(&r->nearest);
        traced_hit(g, r->item, &hit);
        if (pool_begin_next(r, g, &next, end)) at_node[nodes++] = place;
        continue;
      }
      r->top = top;
      const int current = r->child[top], is_leaf = (int)((uint)current >> 31);
      r->current = current;
      __global const float* node = node_at(nodes_of(tree), (uint)current);
      __global const float* block = leaf_block(tree, CAPLET_LEAF_ROW(current));
      fetch_ahead(is_leaf ? block : node);
      at_node[nodes] = at_leaf[leaves] = place;
      nodes += 1 - is_leaf;
      leaves += is_leaf;
    }
  }
}

#endif
