// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Traverses the 8-wide tree for the closest hit or any hit with the same code; list.cl finds all
// hits. One work-item is one ray. With CAPLET_REAL_WIDTH 8 this file tests eight boxes and eight
// primitives at a time; with 1 single.cl tests one after the other.
#ifndef CAPLET_TRACE_TRACE_CL
#define CAPLET_TRACE_TRACE_CL

#include "trace/hits.cl"

#if CAPLET_REAL_WIDTH == 8

// A visited node leaves at most seven of its children on the stack, in both levels of trees, and
// has all eight there while it orders them; the host checks the depth of trees.
#define CAPLET_STACK_SIZE (2 * 7 * CAPLET_TREE_DEPTH_MAX + 1)

// SlabRay is the ray as slab tests use it. Plane p of axis x is crossed at p * near_ix - near_ox,
// or with far_: the true parameter is between the two. With eps = 2^-24, 1/d is off by 5 eps
// (OpenCL allows 2.5 ulp), the products and the difference by eps each, hence the factors 1 -+
// 2^-21; the rounding of o/d and the shapes' own error, which grows with the distance of the origin
// (16 eps at most), are covered by 2^-19 |o| / d. Boxes are padded for the part that grows with the
// primitive.
typedef struct {
  float near_ix, near_iy, near_iz, near_ox, near_oy, near_oz;
  float far_ix, far_iy, far_iz, far_ox, far_oy, far_oz;
  uint near_x, near_y,
      near_z;  // first float of the near plane's row; the far one is 24 further or back
  uint far_x, far_y, far_z;
} SlabRay;

static inline SlabRay slab_ray(float3 o, float3 d) {
  // A vanishing component becomes 2^-64 of the largest: its slab is then crossed at once or never,
  // and nothing is NaN.
  const float largest = max3(fabs(d)), smallest = largest * 0x1p-64f;
  const float3 s =
      (float3)(copysign(fmax(fabs(d.x), smallest), d.x), copysign(fmax(fabs(d.y), smallest), d.y),
               copysign(fmax(fabs(d.z), smallest), d.z));
  const float3 i = clamp(1.0f / s, -1e37f, 1e37f);
  const float3 shift = clamp(o * i, -1e37f, 1e37f);
  const float3 slack = clamp(fabs(i) * (max3(fabs(o)) * 0x1p-19f), 0.0f, 1e37f);
  const float3 near_i = i * (1.0f - 0x1p-21f), far_i = i * (1.0f + 0x1p-21f);
  const float3 near_o = shift * (1.0f - 0x1p-21f) + slack,
               far_o = shift * (1.0f + 0x1p-21f) - slack;
  SlabRay r;
  r.near_ix = near_i.x;
  r.near_iy = near_i.y;
  r.near_iz = near_i.z;
  r.near_ox = near_o.x;
  r.near_oy = near_o.y;
  r.near_oz = near_o.z;
  r.far_ix = far_i.x;
  r.far_iy = far_i.y;
  r.far_iz = far_i.z;
  r.far_ox = far_o.x;
  r.far_oy = far_o.y;
  r.far_oz = far_o.z;
  r.near_x = s.x < 0.0f ? 24 : 0;
  r.far_x = s.x < 0.0f ? 0 : 24;
  r.near_y = s.y < 0.0f ? 32 : 8;
  r.far_y = s.y < 0.0f ? 8 : 32;
  r.near_z = s.z < 0.0f ? 40 : 16;
  r.far_z = s.z < 0.0f ? 16 : 40;
  return r;
}

// Returns the lanes of the children whose box the ray meets within [t_min, t_best], and where it
// enters them.
static inline int8 boxes_met(__global const float* node, const SlabRay* s, float t_min,
                             float t_best, float8* enter) {
  const float8 nx = vload8(0, node + s->near_x) * s->near_ix - s->near_ox;
  const float8 ny = vload8(0, node + s->near_y) * s->near_iy - s->near_oy;
  const float8 nz = vload8(0, node + s->near_z) * s->near_iz - s->near_oz;
  const float8 fx = vload8(0, node + s->far_x) * s->far_ix - s->far_ox;
  const float8 fy = vload8(0, node + s->far_y) * s->far_iy - s->far_oy;
  const float8 fz = vload8(0, node + s->far_z) * s->far_iz - s->far_oz;
  *enter = real_max(real_max(nx, ny), real_max(nz, real_of(t_min)));
  const float8 leave = real_min(real_min(fx, fy), real_min(fz, real_of(t_best)));
  return *enter <= leave;
}

// Does the same and returns bits.
static inline uint node_hits(__global const float* node, const SlabRay* s, float t_min,
                             float t_best, float* enter) {
  float8 near;
  const int8 met = boxes_met(node, s, t_min, t_best, &near);
  vstore8(near, 0, enter);
  return mask_bits(met);
}

// Stack entries order by where the ray enters: parameters are not negative, so their bits order as
// they do.
static inline ulong stack_key(float enter, int child) {
  return ((ulong)as_uint(enter) << 32) | (uint)child;
}

// Writes the child of a node that the ray enters first to `next`, and pushes the others in the way
// on the stack, nearest on top. Returns 0 if none is met.
static inline int visit_node(__global const float* node, const SlabRay* slab, float t_min,
                             float t_best, ulong* stack, int* stack_top, int* next) {
  __global const int* child = (__global const int*)(node + CAPLET_NODE_CHILDREN);
  float enter[8];
  uint bits = node_hits(node, slab, t_min, t_best, enter);
  if (bits == 0) return 0;
  int top = *stack_top;
  uint i = lowest_bit(bits);
  bits &= bits - 1;
  if (bits == 0) {
    *next = child[i];
    return 1;
  }
  ulong first = stack_key(enter[i], child[i]);
  i = lowest_bit(bits);
  bits &= bits - 1;
  ulong second = stack_key(enter[i], child[i]);
  ulong near = min(first, second);
  second = max(first, second);
  if (bits == 0) {
    stack[top] = second;
    *stack_top = top + 1;
    *next = (int)(uint)near;
    return 1;
  }
  i = lowest_bit(bits);
  bits &= bits - 1;
  ulong third = stack_key(enter[i], child[i]);
  const ulong nearest = min(near, third);
  third = max(near, third);
  if (bits == 0) {
    stack[top] = max(second, third);
    stack[top + 1] = min(second, third);
    *stack_top = top + 2;
    *next = (int)(uint)nearest;
    return 1;
  }
  // Four or more are inserted in order, nearest on top.
  const int bottom = top;
  stack[top++] = max(second, third);
  stack[top++] = min(second, third);
  stack[top++] = nearest;
  do {
    i = lowest_bit(bits);
    bits &= bits - 1;
    const ulong key = stack_key(enter[i], child[i]);
    int place = top++;
    while (place > bottom && stack[place - 1] < key) {
      stack[place] = stack[place - 1];
      place--;
    }
    stack[place] = key;
  } while (bits != 0);
  *next = (int)(uint)stack[--top];
  *stack_top = top;
  return 1;
}

// Pops the next entry of the stack above `floor` and skips those that begin behind t_best. Returns
// 0 if there is none.
static inline int pop_entry(const ulong* stack, int* top, int floor, float t_best, int* next) {
  while (*top != floor) {
    const ulong key = stack[--*top];
    if ((uint)(key >> 32) > as_uint(t_best)) continue;
    *next = (int)(uint)key;
    return 1;
  }
  return 0;
}

// Transforms the ray to the space of an instance: its direction is not normalised, so t stays the
// same. Returns 0 if it is not valid in floats.
static inline int ray_to_instance(const Tree* tree, uint instance, float3 world_o, float3 world_d,
                                  float t_min, SlabRay* slab, ShapeRay* shape) {
  const Affine to_object = object_from_world(tree, instance);
  const float3 o = affine_point(&to_object, world_o);
  const float3 d = affine_vector(&to_object, world_d);
  const uint flags = tree->instances[instance].flags;
  *slab = slab_ray(o, d);
  *shape = shape_ray_of(tree, o, d, t_min);
  if (flags & CAPLET_INSTANCE_NO_ENTERING) shape->sees_entering = 0;
  if (flags & CAPLET_INSTANCE_NO_LEAVING) shape->sees_leaving = 0;
  return line_is_valid(o, d);
}

// Returns the closest hit in (t_min, t_max), or any hit nearer than `enough` (0: the closest;
// INFINITY: any). At equal t tie_is_before decides, so that the hit does not depend on the tree or
// on the order of traversal. Zero, infinite and NaN rays miss.
static inline HitRecord trace_ray(const Tree* tree, uint root, RayRecord ray, const float enough) {
  const Floats nodes = nodes_of(tree);
  NearestHit nearest = nothing_before(ray.t_max);
  const float3 world_o = (float3)(ray.ox, ray.oy, ray.oz),
               world_d = (float3)(ray.dx, ray.dy, ray.dz);
  const float t_min = ray.t_min > 0.0f ? ray.t_min : 0.0f;  // never -0: stack keys go by the bits
  if (!line_is_valid(world_o, world_d) || !(ray.t_min < ray.t_max) || !(t_min < nearest.t))
    return hit_record(&nearest);
  uint instance = CAPLET_NONE;

  ulong stack[CAPLET_STACK_SIZE];
  int top = 0, floor = 0;  // below `floor` lie the entries of the upper tree
  SlabRay slab = slab_ray(world_o, world_d);
  ShapeRay shape = shape_ray_of(tree, world_o, world_d, t_min);
  int current = (int)root;
  for (;;) {
    if (current >= 0) {
      __global const float* node = node_at(nodes, (uint)current);
      if (visit_node(node, &slab, t_min, nearest.t, stack, &top, &current)) continue;
    } else {
      const uint kind = CAPLET_LEAF_KIND(current), row = CAPLET_LEAF_ROW(current);
      if (CAPLET_HAS_SHAPE(shape_instance) && kind == shape_instance) {
        instance = ((__global const uint*)leaf_block(tree, row))[0];
        floor = top;
        current = (int)instance_root(tree, instance);
        if (ray_to_instance(tree, instance, world_o, world_d, t_min, &slab, &shape)) continue;
      } else {
        for (uint lane = 0; lane < CAPLET_WIDTH; lane += CAPLET_REAL_WIDTH)
          test_leaf(tree, kind, row, lane, &shape, instance, &nearest);
        if (nearest.found && nearest.t < enough) return hit_record(&nearest);
      }
    }
    while (!pop_entry(stack, &top, floor, nearest.t, &current)) {
      if (!CAPLET_HAS_SHAPE(shape_instance) || instance == CAPLET_NONE) return hit_record(&nearest);
      instance = CAPLET_NONE;
      floor = 0;
      slab = slab_ray(world_o, world_d);
      shape = shape_ray_of(tree, world_o, world_d, t_min);
    }
  }
}

#else

#include "trace/single.cl"

#endif

#ifndef CAPLET_RAYS_ARE_GLOBAL
#if CAPLET_REAL_WIDTH == 1
static inline HitRecord trace_ray(const Tree* tree, uint root, RayRecord ray, const float enough) {
  return trace_ray_at(tree, root, &ray, enough);
}
#endif

// Returns the nearest hit with t in (t_min, t_max).
static inline HitRecord trace_closest(const Tree* tree, RayRecord ray) {
  return trace_ray(tree, world_root(tree), ray, 0.0f);
}

// Returns 1 if anything is hit with t in (t_min, t_max).
static inline int trace_any(const Tree* tree, RayRecord ray) {
  return trace_ray(tree, world_root(tree), ray, INFINITY).slot != CAPLET_NONE;
}
#endif

#endif
