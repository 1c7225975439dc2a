// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The way of one ray through packed nodes: which leaves it comes to, one after the other.
//
// The children of a node are visited in the order of slot ^ octant, which the builder lays them out for. So a node that is left has one number of
// eight bits to remember, its children to come, and the stack has at most an entry a level: the node and that number. Trees may be deeper than the
// stack, twice so with instances. Of a stack that is full the lowest entry makes room. The last one that did is kept (`lost`); when all
// others are done the ray goes down again from the root to its node. Nodes are numbered depth first (host/bvh/bvh.h), so the way leads through the
// child of the greatest number that is none beyond it, and what is to come at each level are the later ones of that child. Children whose boxes
// were met before and are no more, since a nearer hit is known, would have been passed over anyway; there are no others.
#ifndef CAPLET_TRACE_WALK_CL
#define CAPLET_TRACE_WALK_CL

#include "trace/hits.cl"
#include "trace/packed.cl"

// Where rays lie that are traced: those within instances are made of them again and again, so that registers need not hold two.
#ifdef CAPLET_RAYS_ARE_GLOBAL
#define CAPLET_RAY_SPACE __global
#else
#define CAPLET_RAY_SPACE __private
#endif

// Entries of the stack, a power of two. Trees of real scenes have some ten levels.
#ifndef CAPLET_STACK_SIZE
#define CAPLET_STACK_SIZE 32
#endif
// And the entries that were lost last, of the world and of an instance.
#define CAPLET_WALK_ENTRIES (CAPLET_STACK_SIZE + 2)

#define CAPLET_WALK_ENDS 0  // no reference of a leaf

// The stack is an array of its own: what is read at places that are computed would keep all of this out of registers.
typedef struct {
  uint node, mask;   // where the ray is, and that node's children to come: bit slot ^ octant
  uint top, bottom;  // entries [bottom, top) of the stack are there, at their number modulo its size; those below were lost
  uint floor;        // entries from here on are of the tree of the instance
  uint instance;     // CAPLET_NONE: in the world
  BoxRay box;
} Walk;

static inline float3 ray_origin(CAPLET_RAY_SPACE const RayRecord* ray) { return (float3)(ray->ox, ray->oy, ray->oz); }
static inline float3 ray_direction(CAPLET_RAY_SPACE const RayRecord* ray) { return (float3)(ray->dx, ray->dy, ray->dz); }

static inline void walk_push(Walk* w, uint2* stack, uint node, uint mask) {
  if (w->top - w->bottom == CAPLET_STACK_SIZE) {
    const uint of_instance = w->instance != CAPLET_NONE && w->bottom >= w->floor ? 1u : 0u;
    stack[CAPLET_STACK_SIZE + of_instance] = stack[w->bottom % CAPLET_STACK_SIZE];
    w->bottom++;
  }
  stack[w->top++ % CAPLET_STACK_SIZE] = (uint2)(node, mask);
}

// The child of `node` on the way down to node `to`, which is below it; in *key its bit.
static inline uint walk_towards(const Tree* tree, const Walk* w, uint to, uint* key) {
  uint slot = 0, next = 0;
#pragma unroll 1
  for (uint i = 0; i < CAPLET_WIDTH; i++) {
    const uint child = (uint)packed_child(tree->nodes, w->node, i);  // of leaves and of none: greater than any node
    if (child <= to && child > next) {
      next = child;
      slot = i;
    }
  }
  *key = slot ^ w->box.octant;
  return next;
}

// The ray in the space of the world. 0: it meets nothing.
static inline int walk_in_world(CAPLET_RAY_SPACE const RayRecord* ray, __global const float* leaves, Walk* w, ShapeRay* shape) {
  const float3 o = ray_origin(ray), d = ray_direction(ray);
  w->instance = CAPLET_NONE;
  w->floor = 0;
  w->box = box_ray(o, d);
  *shape = shape_ray(o, d, ray->t_min > 0.0f ? ray->t_min : 0.0f, leaves);
  return line_is_valid(o, d);
}

// And in that of an instance: it goes along unnormalised, so t stays what it is. 0: nothing is left of it within floats.
static inline int walk_in_instance(const Tree* tree, CAPLET_RAY_SPACE const RayRecord* ray, uint instance, Walk* w, ShapeRay* shape) {
  __global const InstanceRecord* placed = tree->instances + instance;
  const float3 o = transform_point(placed->object_from_world, ray_origin(ray));
  const float3 d = transform_vector(placed->object_from_world, ray_direction(ray));
  w->instance = instance;
  w->floor = w->top;
  w->box = box_ray(o, d);
  *shape = shape_ray(o, d, shape->t_min, tree->leaves);
  if (placed->flags & CAPLET_INSTANCE_NO_ENTERING) shape->sees_entering = 0;
  if (placed->flags & CAPLET_INSTANCE_NO_LEAVING) shape->sees_leaving = 0;
  return line_is_valid(o, d);
}

// 0: no way at all. Otherwise `shape` is the ray, and the first walk_next has to visit the root.
static inline int walk_begin(const Tree* tree, CAPLET_RAY_SPACE const RayRecord* ray, Walk* w, ShapeRay* shape, float t_best) {
  w->node = w->mask = w->top = w->bottom = 0;
  return walk_in_world(ray, tree->leaves, w, shape) && ray->t_min < ray->t_max && shape->t_min < t_best;
}

// The reference of the next leaf whose box the ray meets before t_best, in whose space `shape` then is, or CAPLET_WALK_ENDS. `visit`: a node to
// begin with, -1: go on.
static inline int walk_next(const Tree* tree, uint root, CAPLET_RAY_SPACE const RayRecord* ray, Walk* w, ShapeRay* shape, uint2* stack,
                            float t_best, int visit) {
  uint again = CAPLET_NONE;  // the node that is to be come to again
  for (;;) {
    const int placed = CAPLET_HAS_SHAPE(shape_instance) && w->instance != CAPLET_NONE;
    if (visit >= 0) {
      w->node = (uint)visit;
      w->mask = packed_node_hits(tree->nodes, w->node, &w->box, shape->ox, shape->oy, shape->oz, shape->t_min, t_best);
      visit = -1;
      if (again == w->node) {
        w->mask = stack[CAPLET_STACK_SIZE + (placed ? 1u : 0u)].y;
        again = CAPLET_NONE;
      } else if (again != CAPLET_NONE) {
        uint key;
        visit = (int)walk_towards(tree, w, again, &key);
        w->mask &= ~((2u << key) - 1u);
        if (w->mask != 0) walk_push(w, stack, w->node, w->mask);
      }
    } else if (w->mask != 0) {
      const uint slot = lowest_bit(w->mask) ^ w->box.octant;
      w->mask &= w->mask - 1u;
      const int next = packed_child(tree->nodes, w->node, slot);
      const int of_instance = CAPLET_HAS_SHAPE(shape_instance) && next < 0 && CAPLET_LEAF_KIND(next) == shape_instance;
      if (next < 0 && !of_instance) return next;
      if (w->mask != 0) walk_push(w, stack, w->node, w->mask);
      w->mask = 0;
      visit = next;
      if (of_instance) {
        const uint instance = ((__global const uint*)tree->leaves)[(size_t)CAPLET_LEAF_ROW(next) * 8];
        visit = walk_in_instance(tree, ray, instance, w, shape) ? (int)tree->instances[instance].root : -1;
      }
    } else if (w->top > max(w->floor, w->bottom)) {
      const uint2 entry = stack[--w->top % CAPLET_STACK_SIZE];
      w->node = entry.x;
      w->mask = entry.y;
    } else if (w->top > w->floor) {
      again = stack[CAPLET_STACK_SIZE + (placed ? 1u : 0u)].x;
      w->top = w->bottom = w->floor;
      visit = (int)(placed ? tree->instances[w->instance].root : root);
    } else if (placed) {
      walk_in_world(ray, tree->leaves, w, shape);
    } else {
      return CAPLET_WALK_ENDS;
    }
  }
}

#endif
