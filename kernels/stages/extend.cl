// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Finds the closest hit of every ray in the queue.
#include "stages/times.cl"

static __global const RayRecord* traced_ray_at(const Stage* g, uint item) {
  return g->rays.path_ray + g->queues.queue[item];
}
static void traced_hit(const Stage* g, uint item, const HitRecord* hit) {
  g->rays.path_hit[g->queues.queue[item]] = *hit;
}
#define TRACED_TREE(g) (&(g)->tree)
#define TRACED_ROOT(g, item) world_root_at(&(g)->tree, TRACED_TIME(g, item))
#define TRACED_TIME(g, item) PATH_TIME(g, (g)->queues.queue[item])
#include "trace/many.cl"
