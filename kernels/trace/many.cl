// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// A stage traces its rays one a work-item, or, where eight lanes are tested at a time, an equal
// share of them a work-item, which traverses the tree with many at once if the device is good at
// it. The including file defines
//   __global const RayRecord* traced_ray_at(const Stage* g, uint item)
//   void traced_hit(const Stage* g, uint item, const HitRecord* hit)
//   TRACED_TREE(g)                   // const Tree*
//   TRACED_ROOT(g, item)             // the number of the node where the ray begins
//   TRACED_UNTIL(g, item)            // if not all rays have one root: the first ray after `item`
//                                    // that may have another
//   TRACED_ENOUGH(g, item)           // if some rays need not find the closest hit: one nearer than
//                                    // this will do (INFINITY: any)
//   TRACED_TIME(g, item)             // when the ray sees the scene, where something moves (Tree)
//   TRACED_NEIGHBOURS                // 1: rays are neighbours of those before them, and of one
//   time
// Programs may be built with CAPLET_ONE_BY_ONE to trace a ray after the other, or with
// CAPLET_PORTABLE to trace many at once on any device.
#ifndef CAPLET_TRACE_MANY_CL
#define CAPLET_TRACE_MANY_CL

#if CAPLET_REAL_WIDTH != 8
#define CAPLET_RAYS_ARE_GLOBAL
#endif
#ifdef TRACED_ENOUGH
#define TRACED_MAY_END_EARLY 1
#else
#define TRACED_MAY_END_EARLY 0
#define TRACED_ENOUGH(g, item) 0.0f
#endif
#ifndef TRACED_TIME
#define TRACED_TIME(g, item) 0.0f
#endif
#ifndef TRACED_UNTIL
#define TRACED_UNTIL(g, item) CAPLET_NONE
#endif
#include "trace/eight.cl"
#include "trace/trace.cl"

#if CAPLET_REAL_WIDTH == 8
static inline RayRecord traced_ray(const Stage* g, uint item) { return *traced_ray_at(g, item); }
// Work-items take shares of their rays (kernel.cl).
#define STAGE_TAKES_SHARES
#if defined(CAPLET_ONE_BY_ONE) || (!defined(CAPLET_EIGHT_IS_FAST) && !defined(CAPLET_PORTABLE))
static void stage_share(const Stage* g, uint begin, uint end) {
  for (; begin < end; begin++) {
    const Tree then = tree_at(TRACED_TREE(g), TRACED_TIME(g, begin));
    const HitRecord hit =
        trace_ray(&then, TRACED_ROOT(g, begin), traced_ray(g, begin), TRACED_ENOUGH(g, begin));
    traced_hit(g, begin, &hit);
  }
}
#elif TRACED_NEIGHBOURS && !defined(CAPLET_MOTION)
#include "trace/stream.cl"
static void stage_share(const Stage* g, uint begin, uint end) {
  while (begin < end) {
    const uint next = min(min(end, TRACED_UNTIL(g, begin)), begin + CAPLET_STREAM_RAYS);
    trace_stream(g, begin, next - begin);
    begin = next;
  }
}
#else
#include "trace/pool.cl"
static void stage_share(const Stage* g, uint begin, uint end) { trace_pool(g, begin, end); }
#endif
#else
static void stage_item(const Stage* g, uint item) {
  const Tree then = tree_at(TRACED_TREE(g), TRACED_TIME(g, item));
  const HitRecord hit =
      trace_ray_at(&then, TRACED_ROOT(g, item), traced_ray_at(g, item), TRACED_ENOUGH(g, item));
  traced_hit(g, item, &hit);
}
#endif

#endif
