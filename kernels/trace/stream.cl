// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Traces neighbouring rays through the tree together, for processors with eight lanes: a node is
// fetched once for all rays that come to it, and each of its children is visited by those that meet
// it. This pays for camera rays, which share most of their way. Those that come to an instance go
// through its tree together, too. Where something moves each ray has a time and a tree of its own,
// and pool.cl traces them. Hits are those of trace_ray to the bit, because the hit does not
// depend on the order of traversal or of tests.
//
// The including file defines what many.cl lists.
#ifndef CAPLET_TRACE_STREAM_CL
#define CAPLET_TRACE_STREAM_CL

#include "trace/pool.cl"

#ifndef CAPLET_STREAM_RAYS
#define CAPLET_STREAM_RAYS 128  // a multiple of 8, at most 256
#endif
// Each node on the path leaves lists of seven children, and the last one writes eight; one list
// begins each tree.
#define CAPLET_STREAM_STACK (7 * CAPLET_PATH_NODES + 8 + 2)

typedef struct {
  float near_ix, near_iy, near_iz, near_ox, near_oy, near_oz;
  float far_ix, far_iy, far_iz, far_ox, far_oy, far_oz;
  float t_min, t_best;  // t_best: as t of the ray's NearestHit
} StreamSlab;

// StreamSpace holds the rays of a stream, by number, in the world or in an instance. Octant 8: the
// ray can hit nothing.
typedef struct {
  StreamSlab slabs[CAPLET_STREAM_RAYS];
  ShapeRay shapes[CAPLET_STREAM_RAYS];
  NearRay near[CAPLET_STREAM_RAYS];
  uchar octants[CAPLET_STREAM_RAYS];
} StreamSpace;

// StreamLists says which rays visit what, one list of numbers after the other, and holds what a
// visit writes.
typedef struct {
  uchar ids[CAPLET_STREAM_STACK * CAPLET_STREAM_RAYS + 16];
  int child[CAPLET_STREAM_STACK], at[CAPLET_STREAM_STACK], count[CAPLET_STREAM_STACK];
  uchar met[CAPLET_STREAM_RAYS + 8], near[CAPLET_STREAM_RAYS + 8];
} StreamLists;

// Returns the bit of the ray's octant.
static inline uint stream_ray(StreamSpace* space, uint id, const SlabRay* s, const ShapeRay* shape,
                              float t_min, float t_best, int valid) {
  StreamSlab* to = &space->slabs[id];
  to->near_ix = s->near_ix;
  to->near_iy = s->near_iy;
  to->near_iz = s->near_iz;
  to->near_ox = s->near_ox;
  to->near_oy = s->near_oy;
  to->near_oz = s->near_oz;
  to->far_ix = s->far_ix;
  to->far_iy = s->far_iy;
  to->far_iz = s->far_iz;
  to->far_ox = s->far_ox;
  to->far_oy = s->far_oy;
  to->far_oz = s->far_oz;
  to->t_min = t_min;
  to->t_best = t_best;
  space->shapes[id] = *shape;
  space->near[id] = near_ray((float3)(shape->ox, shape->oy, shape->oz),
                             (float3)(shape->dx, shape->dy, shape->dz));
  const int octant = valid ? octant_of(s) : 8;
  space->octants[id] = (uchar)octant;
  return 1u << octant;
}

#define STREAM_WALK stream_within_instance
#define WALK_MEETS_INSTANCES 0
#include "trace/stream_walk.cl"

// Traces the n rays whose numbers begin at l->ids[at] through an instance; entries from `top` on
// and numbers behind these are free. The parameters are those of stream_walk.cl and the rays
// inside.
static void stream_instance(const Stage* g, uint first, const Tree* tree, uint instance,
                            StreamSpace* space, StreamSpace* inner, NearestHit* nearest,
                            StreamLists* l, int top, int at, int n) {
  const int begin = at + n;
  uint octants = 0;
  for (int i = 0; i < n; i++) {
    const uint id = l->ids[at + i];
    const RayRecord ray = traced_ray(g, first + id);
    const float t_min = space->slabs[id].t_min;
    SlabRay slab;
    ShapeRay shape;
    const int valid = ray_to_instance(tree, instance, (float3)(ray.ox, ray.oy, ray.oz),
                                      (float3)(ray.dx, ray.dy, ray.dz), t_min, &slab, &shape);
    octants |= stream_ray(inner, id, &slab, &shape, t_min, nearest[id].t, valid);
  }
  for (int flip = 0; flip < 8; flip++) {
    if ((octants >> flip & 1u) == 0) continue;
    int begun = 0;
    for (int i = 0; i < n; i++) {
      const uchar id = l->ids[at + i];
      l->ids[begin + begun] = id;
      begun += inner->octants[id] == flip;
    }
    stream_within_instance(g, first, tree, tree->instances[instance].root, flip, instance, inner,
                           nearest, l, top, begin, begun);
  }
  for (int i = 0; i < n; i++) {
    const uint id = l->ids[at + i];
    space->slabs[id].t_best = nearest[id].t;
  }
}

#define STREAM_WALK stream_world
#define WALK_MEETS_INSTANCES 1
#include "trace/stream_walk.cl"

// Traces rays [first, first + count), at most CAPLET_STREAM_RAYS.
static void trace_stream(const Stage* g, uint first, uint count) {
  const Tree* tree = TRACED_TREE(g);
  StreamSpace space, inner;
  NearestHit nearest[CAPLET_STREAM_RAYS];
  StreamLists lists;
  uint octants = 0;
  for (uint i = 0; i < count; i++) {
    const RayRecord ray = traced_ray(g, first + i);
    const float3 o = (float3)(ray.ox, ray.oy, ray.oz), d = (float3)(ray.dx, ray.dy, ray.dz);
    const SlabRay slab = slab_ray(o, d);
    const float t_min = ray.t_min > 0.0f ? ray.t_min : 0.0f;
    const ShapeRay shape = shape_ray_of(tree, o, d, t_min);
    nearest[i] = nothing_before(ray.t_max);
    const int valid = line_is_valid(o, d) && ray.t_min < ray.t_max && t_min < nearest[i].t;
    octants |= stream_ray(&space, i, &slab, &shape, t_min, nearest[i].t, valid);
  }
  for (int flip = 0; flip < 8; flip++) {
    if ((octants >> flip & 1u) == 0) continue;
    int begun = 0;
    for (uint i = 0; i < count; i++) {
      lists.ids[begun] = (uchar)i;
      begun += space.octants[i] == flip;
    }
    stream_world(g, first, tree, TRACED_ROOT(g, first), flip, CAPLET_NONE, &space, nearest, &lists,
                 0, 0, begun, &inner);
  }
  for (uint i = 0; i < count; i++) {
    const HitRecord hit = hit_record(&nearest[i]);
    traced_hit(g, first + i, &hit);
  }
}

#endif
