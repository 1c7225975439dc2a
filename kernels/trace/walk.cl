// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Walks one ray through packed nodes and returns the leaves that it comes to, one after the other.
//
// The children of a node are visited in the order of slot ^ octant, which the builder lays them out
// for. So only one number of eight bits is remembered for a node that is left, its children to
// come, and the stack has at most an entry a level: the node and that number. Trees may be deeper
// than the stack, twice so with instances. Of a stack that is full the lowest entry makes room. The
// last one that did is kept (`lost`); when all others are done the ray goes down again from the
// root to its node. Nodes are numbered depth first (host/bvh/bvh.h), so the way leads through the
// child of the greatest number that is none beyond it, and what is to come at each level are the
// later ones of that child. Some children's boxes that were met before are no longer met, because a
// nearer hit is known; these would have been skipped anyway. There are no other differences.
#ifndef CAPLET_TRACE_WALK_CL
#define CAPLET_TRACE_WALK_CL

#include "trace/hits.cl"
#include "trace/packed.cl"

// CAPLET_RAY_SPACE is where traced rays lie: rays within instances are recomputed from them again
// and again, so that registers need not hold two.
#ifdef CAPLET_RAYS_ARE_GLOBAL
#define CAPLET_RAY_SPACE __global
#else
#define CAPLET_RAY_SPACE __private
#endif

// The stack has this many entries, a power of two. Trees of real scenes have some ten levels.
#ifndef CAPLET_STACK_SIZE
#define CAPLET_STACK_SIZE 16
#endif
// The walk also keeps the entries that were lost last, of the world and of an instance.
#define CAPLET_WALK_ENTRIES (CAPLET_STACK_SIZE + 2)

// This says whether the ray is ever recomputed: in and after instances, and after shapes that are
// tested apart.
#define CAPLET_WALK_TURNS (CAPLET_HAS_SHAPE(shape_instance) || has_rare_shape)

#define CAPLET_WALK_ENDS 0  // no reference of a leaf

// The stack is an array of its own: what is read at places that are computed would keep all of this
// out of registers.
typedef struct {
  uint node, mask;   // where the ray is, and that node's children to come: bit slot ^ octant
  uint top, bottom;  // entries [bottom, top) of the stack are there, at their number modulo its
                     // size; those below were lost
  uint floor;        // entries from here on are of the tree of the instance
  uint instance;     // CAPLET_NONE: in the world
  int turns;         // 1: the ray is to be made anew
  BoxRay box;
} Walk;

static inline void walk_push(Walk* w, uint2* stack, uint node, uint mask) {
  if (w->top - w->bottom == CAPLET_STACK_SIZE) {
    const uint of_instance = w->instance != CAPLET_NONE && w->bottom >= w->floor ? 1u : 0u;
    stack[CAPLET_STACK_SIZE + of_instance] = stack[w->bottom % CAPLET_STACK_SIZE];
    w->bottom++;
  }
  stack[w->top++ % CAPLET_STACK_SIZE] = (uint2)(node, mask);
}

// Returns the child of `node` on the way down to node `to`, which is below it; in *key its bit.
static inline uint walk_towards(const Tree* tree, const Walk* w, uint to, uint* key) {
  uint slot = 0, next = 0;
#pragma unroll 1
  for (uint i = 0; i < CAPLET_WIDTH; i++) {
    const uint child = (uint)packed_child(nodes_of(tree), w->node,
                                          i);  // of leaves and of none: greater than any node
    if (child <= to && child > next) {
      next = child;
      slot = i;
    }
  }
  *key = slot ^ w->box.octant;
  return next;
}

// Returns the ray in the space of the world or of an instance; its direction is not normalised, so
// t stays the same. It is read anew each time: a compiler that kept it would keep it in registers,
// all the way.
static inline ShapeRay walk_ray(const Tree* tree, CAPLET_RAY_SPACE const RayRecord* ray,
                                uint instance) {
  volatile CAPLET_RAY_SPACE const RayRecord* read = ray;
  float3 o = (float3)(read->ox, read->oy, read->oz), d = (float3)(read->dx, read->dy, read->dz);
  const float t_min = read->t_min;
  uint unseen = 0;
  if (CAPLET_HAS_SHAPE(shape_instance) && instance != CAPLET_NONE) {
    const Affine to_object = object_from_world(tree, instance);
    o = affine_point(&to_object, o);
    d = affine_vector(&to_object, d);
    unseen = tree->instances[instance].flags;
  }
  ShapeRay shape = shape_ray_of(tree, o, d, t_min > 0.0f ? t_min : 0.0f);
  if (unseen & CAPLET_INSTANCE_NO_ENTERING) shape.sees_entering = 0;
  if (unseen & CAPLET_INSTANCE_NO_LEAVING) shape.sees_leaving = 0;
  return shape;
}

// Recomputes the ray in the space where it goes on. Returns 0 if it is not valid in floats.
static inline int walk_turn(const Tree* tree, CAPLET_RAY_SPACE const RayRecord* ray, Walk* w,
                            ShapeRay* shape) {
  *shape = walk_ray(tree, ray, w->instance);
  const float3 o = (float3)(shape->ox, shape->oy, shape->oz),
               d = (float3)(shape->dx, shape->dy, shape->dz);
  w->box = box_ray(o, d);
  w->turns = 0;
  return line_is_valid(o, d);
}

// Starts the walk. Returns 0 if there is nothing to visit. Otherwise the first walk_next has to
// visit the root.
static inline int walk_begin(const Tree* tree, CAPLET_RAY_SPACE const RayRecord* ray, Walk* w,
                             ShapeRay* shape, float t_best) {
  w->node = w->mask = w->top = w->bottom = w->floor = 0;
  w->instance = CAPLET_NONE;
  w->turns = CAPLET_WALK_TURNS;
  if (!CAPLET_WALK_TURNS && !walk_turn(tree, ray, w, shape)) return 0;
  return ray->t_min < ray->t_max && (ray->t_min > 0.0f ? ray->t_min : 0.0f) < t_best;
}

// After this, `shape` and the ray for boxes are recomputed, so registers need not keep them
// meanwhile.
static inline void walk_forget(Walk* w, uint2* stack) {
  if (w->mask != 0) walk_push(w, stack, w->node, w->mask);
  w->mask = 0;
  w->turns = 1;
}

// Returns the reference of the next leaf whose box the ray meets before t_best, in whose space
// `shape` then is, or CAPLET_WALK_ENDS. `visit`: a node to begin with, -1: go on.
static inline int walk_next(const Tree* tree, uint root, CAPLET_RAY_SPACE const RayRecord* ray,
                            Walk* w, ShapeRay* shape, uint2* stack, float t_best, int visit) {
  uint again = CAPLET_NONE,
       left = 0;  // the node that is to be come to again, and its children to come
  for (;;) {
    if (CAPLET_WALK_TURNS && w->turns && !walk_turn(tree, ray, w, shape)) visit = -1;
    const int placed = CAPLET_HAS_SHAPE(shape_instance) && w->instance != CAPLET_NONE;
    if (visit >= 0) {
      w->node = (uint)visit;
      w->mask = packed_node_hits(nodes_of(tree), w->node, &w->box, shape->ox, shape->oy, shape->oz,
                                 shape->t_min, t_best);
      visit = -1;
      if (again == w->node) {
        w->mask = left;
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
      const int next = packed_child(nodes_of(tree), w->node, slot);
      const int of_instance =
          CAPLET_HAS_SHAPE(shape_instance) && next < 0 && CAPLET_LEAF_KIND(next) == shape_instance;
      if (next < 0 && !of_instance) return next;
      if (w->mask != 0) walk_push(w, stack, w->node, w->mask);
      w->mask = 0;
      visit = next;
      if (of_instance) {
        w->instance = ((__global const uint*)leaf_block(tree, CAPLET_LEAF_ROW(next)))[0];
        w->floor = w->top;
        w->turns = 1;
        visit = (int)instance_root(tree, w->instance);
      }
    } else if (w->top > max(w->floor, w->bottom)) {
      const uint2 entry = stack[--w->top % CAPLET_STACK_SIZE];
      w->node = entry.x;
      w->mask = entry.y;
    } else if (w->top > w->floor) {
      const uint2 lost = stack[CAPLET_STACK_SIZE + (placed ? 1u : 0u)];
      again = lost.x;
      left = lost.y;  // on the way down others may be lost
      w->top = w->bottom = w->floor;
      visit = (int)(placed ? instance_root(tree, w->instance) : root);
    } else if (placed) {
      w->instance = CAPLET_NONE;
      w->floor = 0;
      w->turns = 1;
    } else {
      return CAPLET_WALK_ENDS;
    }
  }
}

#endif
