// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Makes hit lists: all crossings of a ray, in order.
#ifndef CAPLET_TRACE_LIST_CL
#define CAPLET_TRACE_LIST_CL

#include "trace/trace.cl"

#ifndef CAPLET_LIST_SPACE
#define CAPLET_LIST_SPACE __global  // where lists are
#endif

// HitList is the list of one ray while it is made: the nearest crossings so far, in order.
typedef struct {
  const Tree* tree;
  CAPLET_LIST_SPACE HitRecord* sorted;
  uint capacity, count;
  int more;       // some were left out
  float t_end;    // crossings at or beyond this t cannot matter; of a full list, those beyond its
                  // last one
  float t_begin;  // nor do those at or before this t
} HitList;

// Orders hits by t; leaving before entering, so that solids that touch are not nested for an
// instant; then by tie_is_before and surface.
static inline int hit_is_before(const Tree* tree, const HitRecord* a,
                                CAPLET_LIST_SPACE const HitRecord* b) {
  if (a->t != b->t) return a->t < b->t;
  const uint a_leaves = a->surface & CAPLET_LEAVING, b_leaves = b->surface & CAPLET_LEAVING;
  if (a_leaves != b_leaves) return a_leaves != 0;
  if (a->slot != b->slot || a->instance != b->instance)
    return tie_is_before(tree, a->slot, a->instance, b->slot, b->instance);
  return a->surface < b->surface;
}

static inline void list_add(HitList* list, float t, uint slot, uint instance, uint surface) {
  if (!(t > list->t_begin && t < list->t_end)) return;
  HitRecord hit;
  hit.t = t;
  hit.slot = slot;
  hit.instance = instance;
  hit.surface = surface;
  uint place = list->count;
  if (place == list->capacity) {
    list->more = 1;
    if (place == 0 || !hit_is_before(list->tree, &hit, list->sorted + place - 1)) return;
    place--;  // the last one makes room
  } else {
    list->count = place + 1;
  }
  for (; place > 0 && hit_is_before(list->tree, &hit, list->sorted + place - 1); place--)
    list->sorted[place] = list->sorted[place - 1];
  list->sorted[place] = hit;
}

// Adds crossings of the primitives in lanes lane .. lane + CAPLET_REAL_WIDTH - 1.
static inline void list_add_span(HitList* list, uint kind, const ShapeRay* ray, Span span,
                                 __global const float* block, uint lane, uint slot, uint instance) {
  const real_mask filled = leaf_lanes_filled(kind, block, lane);
  const uint enter_bits = mask_bits(span.enter & filled), exit_bits = mask_bits(span.exit & filled);
  if ((enter_bits | exit_bits) == 0) return;
  float enter[CAPLET_REAL_WIDTH], exit[CAPLET_REAL_WIDTH];
  int enter_surface[CAPLET_REAL_WIDTH], exit_surface[CAPLET_REAL_WIDTH];
  real_store(span.t_enter, enter);
  real_store(span.t_exit, exit);
  mask_store(span.surface_enter, enter_surface);
  mask_store(span.surface_exit, exit_surface);
  for (uint bits = enter_bits | exit_bits; bits != 0; bits &= bits - 1) {
    const uint i = lowest_bit(bits);
    const int enters = (int)(enter_bits >> i & 1u), leaves = (int)(exit_bits >> i & 1u);
    if (enters && ray->sees_entering)
      list_add(list, enter[i], slot + i, instance, (uint)enter_surface[i]);
    // A solid that is touched at one point is left just after it is entered, whatever the rounding.
    const int touched =
        shape_is_solid(kind) && enters && enter[i] > list->t_begin && exit[i] <= enter[i];
    const float t_exit = touched ? nextafter(enter[i], INFINITY) : exit[i];
    if (leaves && ray->sees_leaving)
      list_add(list, t_exit, slot + i, instance, (uint)exit_surface[i] | CAPLET_LEAVING);
  }
}

static inline void list_add_csg(HitList* list, const ShapeRay* ray, __global const float* block,
                                uint slot, uint instance) {
  for (uint lane = 0; lane < CAPLET_WIDTH; lane++) {
    if (((__global const int*)block)[lane] < 0) continue;
    CsgLine line;
    if (!csg_start(ray, csg_begin(lane_data(block, lane)), &line)) continue;
    float t;
    int side;
    while (csg_next(&line, &t, &side)) list_add(list, t, slot + lane, instance, (uint)side);
  }
}

// Adds the crossings of a leaf block in the tree; not of one of instances.
static inline void list_add_leaf(HitList* list, const ShapeRay* ray, uint kind, uint row,
                                 uint instance) {
  __global const float* block = leaf_block(list->tree, row);
  if (CAPLET_HAS_SHAPE(shape_csg) && kind == shape_csg) {
    list_add_csg(list, ray, block, row * 8, instance);
  } else {
    for (uint lane = 0; lane < CAPLET_WIDTH; lane += CAPLET_REAL_WIDTH) {
      const uint slot = leaf_slot(kind, row, lane);
      list_add_span(list, kind, ray, shape_span(kind, ray, block, lane), block, lane, slot,
                    instance);
#ifdef CAPLET_SHAPES_MOLECULAR_PATCH_CL
      if (kind == shape_molecular_patch)
        list_add_span(list, kind, ray, patch_span_from(ray, block, lane, 2u), block, lane, slot,
                      instance);
#endif
    }
  }
}

// Returns how far the ray still counts: once some crossings are left out, those behind the last one
// kept cannot matter.
static inline float list_end(const HitList* list, float t_end) {
  return list->more ? fmin(t_end, list->sorted[list->capacity - 1].t) : t_end;
}

// Finds all crossings of `ray` with the tree under node `root`, with t in (t_min, t_max), in order
// (hit_is_before). Writes the nearest `capacity` of them to `sorted` and returns their number, or
// capacity + 1 when there are more. The list does not depend on the tree or on the order of
// traversal. capacity 1 finds what trace_closest finds. Zero, infinite and NaN rays miss.
// HitRecord.surface: of open shapes each sheet counts by itself, leaving along its stored normal,
// so closed meshes are entered and left by their winding.
static inline uint trace_list(const Tree* tree, uint root, RayRecord ray, uint capacity,
                              CAPLET_LIST_SPACE HitRecord* sorted) {
  HitList list;
  list.tree = tree;
  list.sorted = sorted;
  list.capacity = capacity;
  list.count = 0;
  list.more = 0;
  list.t_begin = ray.t_min > 0.0f ? ray.t_min : 0.0f;  // never -0: stack keys go by the bits
  list.t_end = ray.t_max;
  float t_best = fmin(ray.t_max, MAXFLOAT);
#if CAPLET_REAL_WIDTH == 1
  uint2 stack[CAPLET_WALK_ENTRIES];
  Walk walk;
  ShapeRay shape;
  if (!walk_begin(tree, &ray, &walk, &shape, t_best)) return 0;
  for (int visit = (int)root;; visit = -1) {
    const int leaf = walk_next(tree, root, &ray, &walk, &shape, stack, t_best, visit);
    if (leaf == CAPLET_WALK_ENDS) return list.more ? capacity + 1 : list.count;
    list_add_leaf(&list, &shape, CAPLET_LEAF_KIND(leaf), CAPLET_LEAF_ROW(leaf), walk.instance);
    if (list.more && capacity == 0) return 1;
    t_best = list_end(&list, t_best);
  }
#else
  const Floats nodes = nodes_of(tree);
  const float t_min = list.t_begin;
  const float3 world_o = (float3)(ray.ox, ray.oy, ray.oz),
               world_d = (float3)(ray.dx, ray.dy, ray.dz);
  if (!line_is_valid(world_o, world_d) || !(ray.t_min < ray.t_max) || !(t_min < ray.t_max))
    return 0;

  uint instance = CAPLET_NONE;
  ulong stack[CAPLET_STACK_SIZE];
  int top = 0, floor = 0;  // below `floor` lie the entries of the upper tree
  SlabRay slab = slab_ray(world_o, world_d);
  ShapeRay shape = shape_ray_of(tree, world_o, world_d, t_min);
  int current = (int)root;
  for (;;) {
    if (current >= 0) {
      __global const float* node = node_at(nodes, (uint)current);
      if (visit_node(node, &slab, t_min, t_best, stack, &top, &current)) continue;
    } else {
      const uint kind = CAPLET_LEAF_KIND(current), row = CAPLET_LEAF_ROW(current);
      if (CAPLET_HAS_SHAPE(shape_instance) && kind == shape_instance) {
        instance = ((__global const uint*)leaf_block(tree, row))[0];
        floor = top;
        current = (int)instance_root(tree, instance);
        if (ray_to_instance(tree, instance, world_o, world_d, t_min, &slab, &shape)) continue;
      } else {
        list_add_leaf(&list, &shape, kind, row, instance);
      }
      if (list.more && capacity == 0) return 1;
      t_best = list_end(&list, t_best);
    }
    while (!pop_entry(stack, &top, floor, t_best, &current)) {
      if (!CAPLET_HAS_SHAPE(shape_instance) || instance == CAPLET_NONE)
        return list.more ? capacity + 1 : list.count;
      instance = CAPLET_NONE;
      floor = 0;
      slab = slab_ray(world_o, world_d);
      shape = shape_ray_of(tree, world_o, world_d, t_min);
    }
  }
#endif
}

// Finds all crossings in the whole scene.
static inline uint trace_all(const Tree* tree, RayRecord ray, uint capacity,
                             CAPLET_LIST_SPACE HitRecord* sorted) {
  return trace_list(tree, world_root(tree), ray, capacity, sorted);
}

#endif
